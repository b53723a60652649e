# Finds Bullet with soft bodies as the target DrapeBullet::bullet. Installed with Drape: its package config uses it too.
#
# Components: float32 (the default) or float64, the two builds that Debian ships; float64 defines
# BT_USE_DOUBLE_PRECISION for whoever links the target. Sets DrapeBullet_FOUND and DrapeBullet_VERSION.
# Why not find_package(Bullet): CMake's module gives no target and ignores the version, and Debian's config file gives
# relative paths. pkg-config is right for both builds.
if(NOT DrapeBullet_FIND_COMPONENTS)
  set(DrapeBullet_FIND_COMPONENTS float32)
endif()
list(GET DrapeBullet_FIND_COMPONENTS 0 _drape_precision)
if(_drape_precision STREQUAL "float64")
  set(_drape_module bullet-float64)
else()
  set(_drape_module bullet)
endif()

find_package(PkgConfig QUIET)
if(PKG_CONFIG_FOUND)
  pkg_check_modules(DrapeBullet_${_drape_precision} QUIET ${_drape_module})
endif()
set(DrapeBullet_VERSION ${DrapeBullet_${_drape_precision}_VERSION})
set(DrapeBullet_LIBRARIES ${DrapeBullet_${_drape_precision}_LINK_LIBRARIES})
find_path(DrapeBullet_INCLUDE_DIR BulletSoftBody/btSoftBody.h
  HINTS ${DrapeBullet_${_drape_precision}_INCLUDE_DIRS} PATH_SUFFIXES bullet)
mark_as_advanced(DrapeBullet_INCLUDE_DIR)
if(DrapeBullet_LIBRARIES)
  set(DrapeBullet_${_drape_precision}_FOUND TRUE)
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(DrapeBullet
  REQUIRED_VARS DrapeBullet_LIBRARIES DrapeBullet_INCLUDE_DIR VERSION_VAR DrapeBullet_VERSION HANDLE_COMPONENTS
  REASON_FAILURE_MESSAGE "pkg-config finds no ${_drape_module} (Debian: libbullet-dev pkgconf)")

if(DrapeBullet_FOUND AND NOT TARGET DrapeBullet::bullet)
  add_library(DrapeBullet::bullet INTERFACE IMPORTED)
  set_target_properties(DrapeBullet::bullet PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${DrapeBullet_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES "${DrapeBullet_LIBRARIES}")
  if(_drape_precision STREQUAL "float64")
    set_target_properties(DrapeBullet::bullet PROPERTIES INTERFACE_COMPILE_DEFINITIONS BT_USE_DOUBLE_PRECISION)
  endif()
endif()
unset(_drape_module)
unset(_drape_precision)
