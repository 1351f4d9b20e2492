# Installs the build into a temporary prefix, then builds and runs a program against it there.
# cmake -DBUILD_DIR=... -DSOURCE_DIR=... -DWORK_DIR=... -DCXX=... -DCC=... -DFLAGS=... -P check.cmake
cmake_minimum_required(VERSION 3.25)

function(run)
    execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
    if(NOT status EQUAL 0)
        list(JOIN ARGV " " command)
        message(FATAL_ERROR "failed (${status}): ${command}\n${out}")
    endif()
    message(STATUS "${out}")
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/tests/install/consumer -B ${WORK_DIR}/build -G Ninja
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_C_COMPILER=${CC} "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/fall_float)
run(${WORK_DIR}/build/fall_double)

# The README's example, as it stands there.
file(READ ${SOURCE_DIR}/README.md readme)
foreach(block "cmake;CMakeLists.txt" "cpp;example.cpp")
    list(GET block 0 language)
    list(GET block 1 name)
    string(REGEX MATCH "```${language}\n([^`]*)```" found "${readme}")
    if(NOT found)
        message(FATAL_ERROR "README.md has no example in ${language}")
    endif()
    file(WRITE ${WORK_DIR}/example/${name} "${CMAKE_MATCH_1}")
endforeach()
run(${CMAKE_COMMAND} -S ${WORK_DIR}/example -B ${WORK_DIR}/example/build -G Ninja
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_C_COMPILER=${CC} "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK_DIR}/example/build)
execute_process(COMMAND ${WORK_DIR}/example/build/example OUTPUT_VARIABLE said)
if(NOT said STREQUAL "95.095 m\n")
    message(FATAL_ERROR "README.md's example says ${said}")
endif()

if(NOT EXISTS ${WORK_DIR}/prefix/share/doc/plumb/LICENSE)
    message(FATAL_ERROR "the licence is not installed")
endif()

# The source tree must not be what made it work.
file(GLOB_RECURSE exported ${WORK_DIR}/prefix/*.cmake)
foreach(file ${exported})
    file(READ ${file} text)
    string(FIND "${text}" "${SOURCE_DIR}" at)
    if(NOT at EQUAL -1)
        message(FATAL_ERROR "${file} names the source tree ${SOURCE_DIR}")
    endif()
endforeach()

# The installed program finds its scenes and shaders beside itself.
if(EXISTS ${WORK_DIR}/prefix/bin/plumb)
    foreach(kind scenes shaders)
        if(NOT EXISTS ${WORK_DIR}/prefix/share/plumb/${kind})
            message(FATAL_ERROR "share/plumb/${kind} is not installed")
        endif()
    endforeach()
    run(${CMAKE_COMMAND} -E chdir ${WORK_DIR} ${WORK_DIR}/prefix/bin/plumb --help)
endif()
file(REMOVE_RECURSE ${WORK_DIR})
