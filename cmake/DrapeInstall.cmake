# Installs what was built, in components: runtime (shared libraries, licence), development (static libraries, public
# headers, CMake package, pkg-config files, documents), tools (programs). DrapePackage.cmake makes packages of them.
# Tests: install.consumer, install.subproject, install.packages.
include(CMakePackageConfigHelpers)
set(DRAPE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Drape)

install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
set(tools "")
foreach(tool cloth_drop drape_check)
  if(TARGET ${tool})
    list(APPEND tools ${tool})
  endif()
endforeach()
if(tools)
  install(TARGETS ${tools} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
  install(FILES docs/scene_files.md docs/scene.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/drape/docs
    COMPONENT tools)
  install(DIRECTORY examples/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/drape/examples COMPONENT tools)
endif()
# Nothing to link without the adapter.
if(NOT DRAPE_WITH_BULLET)
  return()
endif()

install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT development
  FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.json")
install(TARGETS drape drape_recorder EXPORT DrapeTargets
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY bullet_plugin/include/drape recorder/include/drape
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.h")
install(EXPORT DrapeTargets NAMESPACE Drape:: DESTINATION ${DRAPE_CMAKE_DIR} COMPONENT development)

get_target_property(DRAPE_LIBRARY_TYPE drape TYPE)
configure_package_config_file(cmake/DrapeConfig.cmake.in ${PROJECT_BINARY_DIR}/package/DrapeConfig.cmake
  INSTALL_DESTINATION ${DRAPE_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/DrapeConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/DrapeConfig.cmake ${PROJECT_BINARY_DIR}/package/DrapeConfigVersion.cmake
  cmake/FindDrapeBullet.cmake DESTINATION ${DRAPE_CMAKE_DIR} COMPONENT development)

# pkg-config knows a Bullet that has a module of its own. The app's own targets have none: no file is installed then.
if(TARGET BulletSoftBody)
  return()
endif()
set(DRAPE_PC_DOUBLE 0)
set(module bullet)
if(DRAPE_BULLET_DOUBLE)
  set(DRAPE_PC_DOUBLE 1)
  set(module bullet-float64)
endif()
get_target_property(bullet_libraries DrapeBullet::bullet INTERFACE_LINK_LIBRARIES)
get_target_property(bullet_headers DrapeBullet::bullet INTERFACE_INCLUDE_DIRECTORIES)
find_package(PkgConfig QUIET)
if(PKG_CONFIG_FOUND)
  pkg_check_modules(DRAPE_PC QUIET ${module})
endif()
if(DRAPE_PC_LINK_LIBRARIES STREQUAL "${bullet_libraries}")
  set(DRAPE_PC_BULLET "Requires: ${module} >= 3.24")
else()
  list(JOIN bullet_libraries " " DRAPE_PC_BULLET_LIBS)
  string(PREPEND DRAPE_PC_BULLET_LIBS " ")
  set(DRAPE_PC_BULLET_CFLAGS " -I${bullet_headers}")
  if(DRAPE_BULLET_DOUBLE)
    string(APPEND DRAPE_PC_BULLET_CFLAGS " -DBT_USE_DOUBLE_PRECISION")
  endif()
endif()
# Lists the libraries that a user of the static library must link.
if(DRAPE_LIBRARY_TYPE STREQUAL "STATIC_LIBRARY")
  set(DRAPE_PC_STATIC " -DDRAPE_STATIC")
  set(DRAPE_PC_STATIC_LIBS " -pthread")
  foreach(library IN LISTS CMAKE_DL_LIBS)
    string(APPEND DRAPE_PC_STATIC_LIBS " -l${library}")
  endforeach()
endif()
set(DRAPE_PC_RECORDER_REQUIRES "${DRAPE_PC_BULLET}")
if(DRAPE_LIBRARY_TYPE STREQUAL "STATIC_LIBRARY")
  set(DRAPE_PC_RECORDER_REQUIRES "Requires: zlib")
  if(DRAPE_PC_BULLET)
    set(DRAPE_PC_RECORDER_REQUIRES "${DRAPE_PC_BULLET}, zlib")
  endif()
endif()
# The path is relative to the .pc file, so that it stays right after cmake --install --prefix or a move of the tree.
set(pc_dir ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH DRAPE_PC_PREFIX ${pc_dir} ${CMAKE_INSTALL_PREFIX})
file(RELATIVE_PATH DRAPE_PC_INCLUDEDIR ${pc_dir} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
foreach(package drape drape-recorder)
  configure_file(cmake/${package}.pc.in ${PROJECT_BINARY_DIR}/package/${package}.pc @ONLY)
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/package/drape.pc ${PROJECT_BINARY_DIR}/package/drape-recorder.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
