# A build of the target frond alone can be installed, as README.md states for scripts/demo: the program with its man
# pages, and the files for compiling other programs. --component runtime leaves out the latter, as docs/extending.md
# says. A build folder of its own, whose object files are copied from BUILD_DIR and not compiled again.
file(REMOVE_RECURSE "${WORK_DIR}")
set(build "${WORK_DIR}/build")
set(prefix "${WORK_DIR}/prefix")
include("${CMAKE_CURRENT_LIST_DIR}/run_command.cmake")
# In place of the compiler: the words of Ninja's rules are -o FILE and -MF FILE.
file(WRITE "${WORK_DIR}/copy" "#!/bin/sh\nfrom='${BUILD_DIR}'\n" [=[
previous=
for word; do
  case "$previous" in
    -o) object=$word ;;
    -MF) depends=$word ;;
  esac
  previous=$word
done
[ -e "$from/$object" ] || exec "$@"
cp "$from/$object" "$object" && echo "$object:" >"$depends"
]=])
file(CHMOD "${WORK_DIR}/copy" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
file(STRINGS "${BUILD_DIR}/CMakeCache.txt" options
     REGEX "^(CMAKE_BUILD_TYPE|CMAKE_CXX_COMPILER|CMAKE_CXX_FLAGS|FROND_INSTRUCTIONS|FROND_PRECOMPILED_HEADERS|FROND_UNITY_BUILD):")
list(TRANSFORM options PREPEND "-D")
run(${CMAKE_COMMAND} -S "${SOURCE_DIR}" -B "${build}" -G Ninja ${options} -DFROND_PYTHON=OFF -DFROND_TESTS=OFF -DFROND_BENCH=OFF
    "-DCMAKE_CXX_COMPILER_LAUNCHER=${WORK_DIR}/copy")
run(${CMAKE_COMMAND} --build "${build}" --target frond)
run(${CMAKE_COMMAND} --install "${build}" --prefix "${prefix}")
run("${prefix}/bin/frond" --version)
file(GLOB pages "${prefix}/share/man/man1/frond-render.1*")
if(NOT pages OR NOT EXISTS "${prefix}/share/bash-completion/completions/frond")
  message(FATAL_ERROR "there is no man page or no completion in ${prefix}")
endif()
file(GLOB_RECURSE development RELATIVE "${prefix}" "${prefix}/*.h" "${prefix}/*.cmake")
foreach(name "include/frond/render/session.h" "include/frond/core/material.h" "cmake/frond/frondConfig.cmake")
  string(FIND "${development}" "${name}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "there is no ${name} in ${prefix}: ${development}")
  endif()
endforeach()
run(${CMAKE_COMMAND} --install "${build}" --prefix "${prefix}-runtime" --component runtime)
run("${prefix}-runtime/bin/frond" --version)
file(GLOB_RECURSE development "${prefix}-runtime/*.h" "${prefix}-runtime/*.cmake")
if(development)
  message(FATAL_ERROR "--component runtime installs ${development}")
endif()
file(REMOVE_RECURSE "${WORK_DIR}")
