# What someone with another renderer links: find_package(latewarp) brings lw::warp_server and lw::frame_link, and below
# them lw::core, lw::gl and lw::shaders. examples/own_renderer uses it, and a test builds that against an installation.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(installed_folders core shaders gl frame_link warp_server)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/latewarp)

foreach(folder IN LISTS installed_folders)
  install(TARGETS lw_${folder} EXPORT latewarpTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/latewarp
    COMPONENT library FILES_MATCHING PATTERN "*.h")
endforeach()
install(EXPORT latewarpTargets NAMESPACE lw:: DESTINATION ${package_dir} COMPONENT library)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/latewarpConfig.cmake.in
  ${PROJECT_BINARY_DIR}/latewarpConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/latewarpConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/latewarpConfig.cmake ${PROJECT_BINARY_DIR}/latewarpConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT library)

if(TARGET latewarp)
  install(TARGETS latewarp RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
