# Debian's robin-map-dev, whose version OpenImageIO's own module does not find.
find_path(ROBINMAP_INCLUDE_DIR tsl/robin_map.h REQUIRED)
set(ROBINMAP_INCLUDES "${ROBINMAP_INCLUDE_DIR}")
set(Robinmap_FOUND TRUE)
