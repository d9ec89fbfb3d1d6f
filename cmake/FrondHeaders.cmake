# Plug-ins record the headers that they were compiled from (core/build_record.h): they see copies in frond_headers, each of
# which ends in a line that leaves its path and a hash in the shared object. The library has the table of its own
# (frond_header_table). Comments do not count.
set(frond_headers "${CMAKE_CURRENT_BINARY_DIR}/include")
set(frond_header_table "${frond_generated}/header_table.cpp")
set(src "${CMAKE_CURRENT_SOURCE_DIR}/src")
foreach(layer IN LISTS frond_layers)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE "${src}" "${src}/${layer}/*.h")
  list(APPEND frond_header_paths ${headers})
endforeach()
file(GLOB_RECURSE copies RELATIVE "${frond_headers}" "${frond_headers}/*.h")
foreach(copy IN LISTS copies)
  if(NOT copy IN_LIST frond_header_paths)
    file(REMOVE "${frond_headers}/${copy}")
  endif()
endforeach()
include("${CMAKE_CURRENT_LIST_DIR}/FrondHashOfCode.cmake")
# write_if_different(FILE TEXT): what is the same keeps its time, and nothing is compiled anew.
function(write_if_different file text)
  if(EXISTS "${file}")
    file(READ "${file}" old)
    if(old STREQUAL text)
      return()
    endif()
  endif()
  file(WRITE "${file}" "${text}")
endfunction()
set(rows "")
foreach(header IN LISTS frond_header_paths)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${src}/${header}")
  file(READ "${src}/${header}" text)
  frond_hash_of_code(hash "${text}")
  string(MAKE_C_IDENTIFIER "${header}" name)
  write_if_different("${frond_headers}/${header}" "${text}
namespace {
[[gnu::used, gnu::section(\"frond_headers\")]] const char frond_header_${name}[] = \"${header} ${hash}\";
}
")
  string(APPEND rows "    {\"${header}\", \"${hash}\"},\n")
endforeach()
write_if_different("${frond_header_table}" "#include \"system/build_check.h\"

namespace frond {

const std::map<std::string_view, std::string_view>& own_headers() {
  static const std::map<std::string_view, std::string_view> table{
${rows}  };
  return table;
}

}  // namespace frond
")
