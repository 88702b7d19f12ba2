# What cmake --install lays down: the program (component program), and what others build on (component dev).
include(CMakePackageConfigHelpers)

# The readers' own headers stay here: they need libraries that nobody else does.
set(inner_headers PATTERN "gltf_*" EXCLUDE PATTERN patch_topology.h EXCLUDE PATTERN image_file_module.h EXCLUDE
  PATTERN openimageio EXCLUDE)
foreach(room meshing formfactor solver apps/imaging apps/run apps/verification)
  get_filename_component(name ${room} NAME)
  target_compile_features(patchlight_${name} PUBLIC cxx_std_20)
  target_include_directories(patchlight_${name} INTERFACE $<INSTALL_INTERFACE:include/patchlight>)
  set_target_properties(patchlight_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS patchlight_${name} EXPORT patchlight ARCHIVE DESTINATION lib COMPONENT dev)
  install(DIRECTORY ${room}/ DESTINATION include/patchlight/${room} COMPONENT dev
    FILES_MATCHING ${inner_headers} PATTERN "*.h")
endforeach()
# Programs that write pictures look for the module of picture files there.
target_link_options(patchlight_imaging INTERFACE $<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/lib/patchlight>)

set(config_folder lib/cmake/patchlight)
install(EXPORT patchlight NAMESPACE patchlight:: FILE patchlight-targets.cmake DESTINATION ${config_folder}
  COMPONENT dev)
configure_package_config_file(cmake/patchlight-config.cmake.in ${PROJECT_BINARY_DIR}/patchlight-config.cmake
  INSTALL_DESTINATION ${config_folder})
# Before 1.0 a minor version may change everything.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/patchlight-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/patchlight-config.cmake ${PROJECT_BINARY_DIR}/patchlight-config-version.cmake
  cmake/dependencies.cmake DESTINATION ${config_folder} COMPONENT dev)

install(FILES cmake/copyright LICENSE DESTINATION share/doc/patchlight)
install(FILES cmake/copyright DESTINATION share/doc/patchlight-dev COMPONENT dev)
install(DIRECTORY tests/package/example/ DESTINATION share/doc/patchlight-dev/example COMPONENT dev)

if(TARGET patchlight_python)
  set(python_folder lib/python3/dist-packages/patchlight)
  set_target_properties(patchlight_python PROPERTIES INSTALL_RPATH "$ORIGIN/../../../patchlight")
  install(TARGETS patchlight_python LIBRARY DESTINATION ${python_folder})
  install(DIRECTORY ${PROJECT_BINARY_DIR}/python/patchlight/ DESTINATION ${python_folder}
    PATTERN "*.so" EXCLUDE PATTERN __pycache__ EXCLUDE)
endif()
