# One folder, one target: lw_<folder> with the alias lw::<folder>, made of every .cpp below it.

add_library(lw_options INTERFACE)
add_library(lw::options ALIAS lw_options)
target_compile_options(lw_options INTERFACE
  $<BUILD_INTERFACE:-Wall;-Wextra;-Wconversion;-Wshadow;-Wnon-virtual-dtor>
  # The compiler of the builds and of CI; another one may warn of more.
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Werror>>
  # The same bytes on every machine: a multiply and an add are fused only where a kernel writes so itself.
  $<BUILD_INTERFACE:-ffp-contract=off>)
if(LW_SANITIZE)
  target_compile_options(lw_options INTERFACE
    $<BUILD_INTERFACE:-fsanitize=${LW_SANITIZE};-fno-omit-frame-pointer;-fno-sanitize-recover=all>)
  target_link_options(lw_options INTERFACE -fsanitize=${LW_SANITIZE})
  # Sanitized code hides from gcc which paths set a variable; the plain presets keep this warning.
  target_compile_options(lw_options INTERFACE
    $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>>)
endif()

# lw_add_library(<folder> PUBLIC <libs...> PRIVATE <libs...>)
function(lw_add_library folder)
  cmake_parse_arguments(arg "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  if(NOT sources)
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/empty.cpp "")
    set(sources ${CMAKE_CURRENT_BINARY_DIR}/empty.cpp)
  endif()
  add_library(lw_${folder} STATIC ${sources})
  add_library(lw::${folder} ALIAS lw_${folder})
  set_target_properties(lw_${folder} PROPERTIES EXPORT_NAME ${folder} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(lw_${folder} PUBLIC cxx_std_20)
  target_include_directories(lw_${folder} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/latewarp>)
  target_link_libraries(lw_${folder} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:lw::options>)
endfunction()

# lw_add_test(<folder> LIBS <libs...> [LABELS <labels...>]): one test program per folder of tests/.
# Every case carries the folder's labels; a case whose suite is named Gl*, Data* or Slow* has that label too.
function(lw_add_test folder)
  cmake_parse_arguments(arg "" "" "LIBS;LABELS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  if(NOT sources)
    return()
  endif()
  foreach(library IN LISTS arg_LIBS)
    if(library MATCHES "^lw::" AND NOT TARGET ${library})
      return()  # LW_BUILD_APPS=OFF leaves its folder out
    endif()
  endforeach()
  set(target lw_test_${folder})
  add_executable(${target} ${sources})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE ${arg_LIBS} lw::options GTest::gmock GTest::gtest_main)
  target_compile_definitions(${target} PRIVATE
    LW_SOURCE_DIR="${PROJECT_SOURCE_DIR}" LW_TEST_OUTPUT_DIR="${PROJECT_BINARY_DIR}/test-output")
  if(NOT arg_LABELS)
    set(arg_LABELS unit)
  endif()
  include(GoogleTest)
  set(filter_gl "Gl*-Gltf*")
  set(filter_data "Data*")
  set(filter_slow "Slow*")
  foreach(label gl data slow)
    gtest_discover_tests(${target} DISCOVERY_MODE PRE_TEST TEST_PREFIX ${folder}. TEST_FILTER "${filter_${label}}"
      TEST_LIST ${target}_${label} PROPERTIES LABELS "${label}" TIMEOUT 600)
  endforeach()
  # A filter cannot take back what it took away: the rest is everything but Gl*, and Gltf*.
  set(filter_rest "-Gl*:Data*:Slow*")
  set(filter_gltf "Gltf*")
  foreach(part rest gltf)
    gtest_discover_tests(${target} DISCOVERY_MODE PRE_TEST TEST_PREFIX ${folder}. TEST_FILTER "${filter_${part}}"
      TEST_LIST ${target}_${part} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT 300)
  endforeach()
endfunction()
