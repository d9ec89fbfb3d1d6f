# Installs the build in BUILD_DIR to a folder of its own, then configures, builds and runs this project and the examples
# against it, and against the build itself.
set(prefix "${WORK_DIR}/prefix")
file(REMOVE_RECURSE "${WORK_DIR}")
include("${CMAKE_CURRENT_LIST_DIR}/run_command.cmake")
run(${CMAKE_COMMAND} --install "${BUILD_DIR}" --prefix "${prefix}")
run("${prefix}/bin/frond" --version)
run(${CMAKE_COMMAND} -S "${CMAKE_CURRENT_LIST_DIR}" -B "${WORK_DIR}/build" -G Ninja "-DCMAKE_PREFIX_PATH=${prefix}")
run(${CMAKE_COMMAND} --build "${WORK_DIR}/build")
run("${WORK_DIR}/build/consumer")

set(embed "${CMAKE_CURRENT_LIST_DIR}/../../examples/embed")
run(${CMAKE_COMMAND} -S "${embed}" -B "${WORK_DIR}/embed" -G Ninja "-DCMAKE_PREFIX_PATH=${prefix}")
run(${CMAKE_COMMAND} --build "${WORK_DIR}/embed")
run("${WORK_DIR}/embed/embed" "${CMAKE_CURRENT_LIST_DIR}/../../scenes/soybean-front/scene.pbrt")

set(example "${CMAKE_CURRENT_LIST_DIR}/../../examples/plugins")
run(${CMAKE_COMMAND} -S "${example}" -B "${WORK_DIR}/plugin" -G Ninja "-DCMAKE_PREFIX_PATH=${prefix}")
run(${CMAKE_COMMAND} --build "${WORK_DIR}/plugin")
# The same from the build folder, without an installation.
run(${CMAKE_COMMAND} -S "${CMAKE_CURRENT_LIST_DIR}" -B "${WORK_DIR}/of_build" -G Ninja "-Dfrond_DIR=${BUILD_DIR}")
run(${CMAKE_COMMAND} --build "${WORK_DIR}/of_build")
run("${WORK_DIR}/of_build/consumer")
run(${CMAKE_COMMAND} -S "${example}" -B "${WORK_DIR}/plugin_of_build" -G Ninja "-DCMAKE_PREFIX_PATH=${BUILD_DIR}")
run(${CMAKE_COMMAND} --build "${WORK_DIR}/plugin_of_build")
run("${BUILD_DIR}/frond" describe --plugin "${WORK_DIR}/plugin_of_build/soil.so" soil)

set(frond "${prefix}/bin/frond")
set(plugin --plugin "${WORK_DIR}/plugin/soil.so")
run("${frond}" describe ${plugin} soil)
run("${frond}" conform ${plugin} soil --samples 2000)
run("${frond}" render ${plugin} "${example}/soil.pbrt" -o "${WORK_DIR}/soil.png" --quick)
set(others --plugin "${WORK_DIR}/plugin/led.so" --plugin "${WORK_DIR}/plugin/blade.so")
run("${frond}" render ${plugin} ${others} "${example}/grass.pbrt" -o "${WORK_DIR}/grass.png" --quick)

# One that was compiled from another header is refused by that header's name.
set(header "${prefix}/include/frond/core/light.h")
file(READ "${header}" text)
string(REGEX REPLACE "core/light.h [0-9a-f]+" "core/light.h 0123456789abcdef" changed "${text}")
file(WRITE "${header}" "${changed}")
run(${CMAKE_COMMAND} --build "${WORK_DIR}/plugin" --target led)
execute_process(COMMAND "${frond}" list --plugin "${WORK_DIR}/plugin/led.so" RESULT_VARIABLE result ERROR_VARIABLE message)
if(NOT result EQUAL 1 OR NOT message MATCHES "other headers than this frond [(]core/light.h[)]")
  message(FATAL_ERROR "a plug-in of another header: ${result}\n${message}")
endif()
file(WRITE "${header}" "${text}")

# Without the shared object for image files, what reads or writes none works, and renders are refused by a word of it.
file(GLOB codec "${prefix}/lib*/libfrond_image.so.*" "${prefix}/lib*/*/libfrond_image.so.*")
file(RENAME "${codec}" "${codec}.away")
run("${frond}" list)
execute_process(COMMAND "${frond}" render ${plugin} "${example}/soil.pbrt" -o "${WORK_DIR}/without.png" --quick
                RESULT_VARIABLE result ERROR_VARIABLE message)
file(RENAME "${codec}.away" "${codec}")
if(NOT result EQUAL 1 OR NOT message MATCHES "libfrond_image.so.*there is no such file")
  message(FATAL_ERROR "without libfrond_image.so: ${result}\n${message}")
endif()

# A limit on the size of files is reported, and no incomplete file is left.
execute_process(COMMAND sh -c "ulimit -f 1; exec \"$0\" \"$@\"" "${frond}" render ${plugin} "${example}/soil.pbrt"
                        -o "${WORK_DIR}/limited.exr" --quick
                RESULT_VARIABLE result ERROR_VARIABLE message)
if(NOT result EQUAL 1 OR NOT message MATCHES "limited.exr\": File too large" OR EXISTS "${WORK_DIR}/limited.exr")
  message(FATAL_ERROR "past a limit on the size of files: ${result}\n${message}")
endif()
