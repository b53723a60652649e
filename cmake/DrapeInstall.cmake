# Installs Drape::drape and Drape::recorder: libraries, public headers, CMake package and pkg-config files. Test:
# install.consumer.
include(CMakePackageConfigHelpers)
set(DRAPE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Drape)

install(TARGETS drape drape_recorder EXPORT DrapeTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY bullet_plugin/include/drape recorder/include/drape
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT DrapeTargets NAMESPACE Drape:: DESTINATION ${DRAPE_CMAKE_DIR})

get_target_property(DRAPE_LIBRARY_TYPE drape TYPE)
configure_package_config_file(cmake/DrapeConfig.cmake.in ${PROJECT_BINARY_DIR}/package/DrapeConfig.cmake
  INSTALL_DESTINATION ${DRAPE_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/DrapeConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/DrapeConfig.cmake ${PROJECT_BINARY_DIR}/package/DrapeConfigVersion.cmake
  cmake/FindDrapeBullet.cmake DESTINATION ${DRAPE_CMAKE_DIR})

if(DRAPE_BULLET_DOUBLE)
  set(DRAPE_PC_BULLET bullet-float64)
  set(DRAPE_PC_DOUBLE 1)
else()
  set(DRAPE_PC_BULLET bullet)
  set(DRAPE_PC_DOUBLE 0)
endif()
# Lists the libraries that a user of the static library must link.
if(DRAPE_LIBRARY_TYPE STREQUAL "STATIC_LIBRARY")
  set(DRAPE_PC_STATIC_REQUIRES ", OpenCL")
  set(DRAPE_PC_STATIC_LIBS " -pthread")
  set(DRAPE_PC_RECORDER_REQUIRES ", zlib")
endif()
# The path is relative to the .pc file, so that it stays right after cmake --install --prefix or a move of the tree.
set(pc_dir ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH DRAPE_PC_PREFIX ${pc_dir} ${CMAKE_INSTALL_PREFIX})
file(RELATIVE_PATH DRAPE_PC_INCLUDEDIR ${pc_dir} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
foreach(package drape drape-recorder)
  configure_file(cmake/${package}.pc.in ${PROJECT_BINARY_DIR}/package/${package}.pc @ONLY)
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/package/drape.pc ${PROJECT_BINARY_DIR}/package/drape-recorder.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
