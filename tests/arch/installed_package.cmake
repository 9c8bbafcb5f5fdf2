# cmake -DBUILD_DIR=<build> -DEXAMPLE_DIR=<source> -DWORK_DIR=<scratch> -P installed_package.cmake
# Installs the libraries, builds examples/own_renderer against them with find_package, and runs it.
file(REMOVE_RECURSE ${WORK_DIR})
set(prefix ${WORK_DIR}/prefix)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed with ${status}: ${ARGN}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --component library)
set(flags)
if(SANITIZE)
  set(flags -DCMAKE_CXX_FLAGS=-fsanitize=${SANITIZE})
endif()
run(${CMAKE_COMMAND} -S ${EXAMPLE_DIR} -B ${WORK_DIR}/build -G Ninja -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF -DCMAKE_CXX_COMPILER_LAUNCHER=${CXX_LAUNCHER}
  ${flags})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/own_renderer ${WORK_DIR}/pictures)
file(GLOB pictures ${WORK_DIR}/pictures/*.png)
list(LENGTH pictures count)
if(NOT count EQUAL 6)
  message(FATAL_ERROR "6 pictures expected, ${count} written")
endif()
