# Debian packages, by `cpack` in the build folder: patchlight (the program) and patchlight-dev (to build on it).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR Patchlight)
set(CPACK_PACKAGE_CONTACT "Patchlight maintainers <maintainers@patchlight.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/package_date.cmake)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian_files.cmake)
set(CPACK_COMPONENTS_ALL program dev)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME patchlight)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# Pictures are labelled with that font.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS fonts-dejavu-core)
if(TARGET patchlight_python)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
endif()
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "adaptive-meshing radiosity
Solves the light between diffuse surfaces on a coarse patch mesh, finds where
the mesh is wrong, refines it there, solves again, and shows before and after,
with the error measured.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME patchlight-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(dev_depends "patchlight (= ${PROJECT_VERSION})" libglm-dev libtbb-dev libboost-dev nlohmann-json3-dev libembree-dev
  libopenmesh-dev libtinyobjloader-dev libtinygltf-dev libfmt-dev libssl-dev libgmp-dev)
list(JOIN dev_depends ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEV_DESCRIPTION "adaptive-meshing radiosity, to build on
Headers and static libraries of patchlight's meshing, form factors, solver,
pictures and run folders, for CMake's find_package, and an example.")
include(CPack)
