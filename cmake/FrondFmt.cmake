# fmt, which frond's headers show: used here and by the installed package.
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
if(NOT TARGET frond_fmt)
  add_library(frond_fmt INTERFACE IMPORTED GLOBAL)
  target_link_libraries(frond_fmt INTERFACE fmt::fmt)
  # OpenImageIO's headers switch fmt's exceptions off for the whole program unless this is set everywhere.
  target_compile_definitions(frond_fmt INTERFACE FMT_EXCEPTIONS=1)
endif()
