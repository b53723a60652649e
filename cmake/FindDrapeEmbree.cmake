# Finds Embree 4 or 3 (Ubuntu 24.04 has the one, Debian 12 the other) as the target DrapeEmbree::embree.
# Code that uses it includes <embree4/rtcore.h> when __has_include finds it, else <embree3/rtcore.h>.
# By path: Debian's CMake file for Embree names no target when other packages are absent.
foreach(major 4 3)
  find_path(DrapeEmbree${major}_INCLUDE_DIR embree${major}/rtcore.h)
  find_library(DrapeEmbree${major}_LIBRARY embree${major})
  mark_as_advanced(DrapeEmbree${major}_INCLUDE_DIR DrapeEmbree${major}_LIBRARY)
  if(DrapeEmbree${major}_INCLUDE_DIR AND DrapeEmbree${major}_LIBRARY)
    set(DrapeEmbree_INCLUDE_DIR ${DrapeEmbree${major}_INCLUDE_DIR})
    set(DrapeEmbree_LIBRARY ${DrapeEmbree${major}_LIBRARY})
    break()
  endif()
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(DrapeEmbree REQUIRED_VARS DrapeEmbree_LIBRARY DrapeEmbree_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "Debian: libembree-dev")

if(DrapeEmbree_FOUND AND NOT TARGET DrapeEmbree::embree)
  add_library(DrapeEmbree::embree UNKNOWN IMPORTED)
  set_target_properties(DrapeEmbree::embree PROPERTIES
    IMPORTED_LOCATION ${DrapeEmbree_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${DrapeEmbree_INCLUDE_DIR})
endif()
