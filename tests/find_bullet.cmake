# The test install.find_bullet configures small projects that have Bullet in different ways, and checks which one Drape
# takes.
#
# Input: MODULE (the folder of FindDrapeBullet.cmake), WORK (made anew), COMPILER. The Bullets here are headers with a
# version and libraries without content; nothing is built.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK})
set(parts LinearMath BulletCollision BulletDynamics BulletSoftBody)

# A source tree as Bullet's: targets without include folders, definitions of the directory.
file(WRITE ${WORK}/own/src/LinearMath/btScalar.h "#define BT_BULLET_VERSION 326\n")
file(WRITE ${WORK}/own/CMakeLists.txt "add_definitions(\${OWN_DEFINITIONS})\n")
foreach(part IN LISTS parts)
  file(APPEND ${WORK}/own/CMakeLists.txt "add_subdirectory(src/${part})\n")
  file(WRITE ${WORK}/own/src/${part}/CMakeLists.txt "add_library(${part} part.cpp)\n")
  file(WRITE ${WORK}/own/src/${part}/part.cpp "")
endforeach()

# Installed ones, in float and in double.
foreach(precision float32 float64)
  set(prefix ${WORK}/${precision})
  file(WRITE ${prefix}/include/bullet/LinearMath/btScalar.h "#define BT_BULLET_VERSION 325\n")
  foreach(part IN LISTS parts)
    file(WRITE ${prefix}/lib/lib${part}.a "")
  endforeach()
  set(definitions "")
  if(precision STREQUAL "float64")
    set(definitions -DBT_USE_DOUBLE_PRECISION)
  endif()
  file(WRITE ${prefix}/lib/cmake/bullet/BulletConfig.cmake "set(BULLET_DEFINITIONS \"${definitions}\")
set(BULLET_INCLUDE_DIRS include/bullet)
set(BULLET_LIBRARIES \"${parts}\")
set(BULLET_LIBRARY_DIRS lib)
set(BULLET_ROOT_DIR ${prefix})\n")
endforeach()

file(WRITE ${WORK}/app/CMakeLists.txt "cmake_minimum_required(VERSION 3.16)
project(App LANGUAGES CXX)
list(APPEND CMAKE_MODULE_PATH ${MODULE})
if(OWN STREQUAL before)
  add_subdirectory(${WORK}/own own)
endif()
find_package(DrapeBullet 3.24 MODULE REQUIRED COMPONENTS \${PRECISION})
if(OWN STREQUAL after)
  add_subdirectory(${WORK}/own own)
endif()
foreach(property INCLUDE_DIRECTORIES LINK_LIBRARIES COMPILE_DEFINITIONS)
  get_target_property(value DrapeBullet::bullet INTERFACE_\${property})
  message(\"\${property} \${value}\")
endforeach()
message(\"VERSION \${DrapeBullet_VERSION}\")\n")

# expect_bullet(<name> GOOD|BAD <cache definitions>... SHOWS <regular expressions>...): configures twice, since the
# second time has the first one's cache.
function(expect_bullet name good)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "SHOWS")
  foreach(turn 1 2)
    execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK}/app -B ${WORK}/build_${name} -D CMAKE_CXX_COMPILER=${COMPILER}
        ${arg_UNPARSED_ARGUMENTS}
      OUTPUT_VARIABLE text ERROR_VARIABLE text RESULT_VARIABLE result)
    string(REGEX REPLACE "[ \n]+" " " words "${text}")
    foreach(shown IN LISTS arg_SHOWS)
      if(NOT words MATCHES "${shown}")
        message(FATAL_ERROR "${name}, turn ${turn}: ${shown} is missing in\n${text}")
      endif()
    endforeach()
    if((good STREQUAL "GOOD" AND NOT result EQUAL 0) OR (good STREQUAL "BAD" AND result EQUAL 0))
      message(FATAL_ERROR "${name}, turn ${turn}: ended with ${result}\n${text}")
    endif()
  endforeach()
  message("${name}: as expected")
endfunction()

set(in_tree "LINK_LIBRARIES BulletSoftBody.BulletDynamics.BulletCollision.LinearMath" "VERSION 3.26")
expect_bullet(own_targets GOOD -D PRECISION=float32 -D OWN=before -D OWN_DEFINITIONS=-DBT_THREADSAFE=1
  -D CMAKE_PREFIX_PATH=${WORK}/float32
  SHOWS ${in_tree} "INCLUDE_DIRECTORIES ${WORK}/own/src " "COMPILE_DEFINITIONS BT_THREADSAFE=1 ")
expect_bullet(own_targets_in_double GOOD -D PRECISION=float64 -D OWN=before
  -D OWN_DEFINITIONS=-DBT_USE_DOUBLE_PRECISION SHOWS ${in_tree} "COMPILE_DEFINITIONS BT_USE_DOUBLE_PRECISION ")
expect_bullet(own_targets_in_the_other_precision BAD -D PRECISION=float32 -D OWN=before
  -D OWN_DEFINITIONS=-DBT_USE_DOUBLE_PRECISION -D CMAKE_PREFIX_PATH=${WORK}/float32
  SHOWS "configured for Bullet in float32, but the app's target BulletSoftBody is in the other precision")
expect_bullet(own_targets_too_late BAD -D PRECISION=float32 -D OWN=after -D CMAKE_PREFIX_PATH=${WORK}/float32
  SHOWS "add Bullet's folder before Drape's")
expect_bullet(installed GOOD -D PRECISION=float32 -D CMAKE_PREFIX_PATH=${WORK}/float32
  SHOWS "INCLUDE_DIRECTORIES ${WORK}/float32/include/bullet " "VERSION 3.25"
    "${WORK}/float32/lib/libBulletSoftBody.a;.*/libBulletDynamics.a;.*/libBulletCollision.a;.*/libLinearMath.a")
expect_bullet(installed_in_double GOOD -D PRECISION=float64 -D Bullet_ROOT=${WORK}/float64
  SHOWS "INCLUDE_DIRECTORIES ${WORK}/float64/include/bullet " "COMPILE_DEFINITIONS BT_USE_DOUBLE_PRECISION ")
expect_bullet(installed_in_the_other_precision BAD -D PRECISION=float32 -D Bullet_DIR=${WORK}/float64/lib/cmake/bullet
  SHOWS "configured for Bullet in float32, but the Bullet in ${WORK}/float64/lib/cmake/bullet is in the other")
expect_bullet(named_but_missing BAD -D PRECISION=float32 -D Bullet_ROOT=${WORK}/nowhere
  SHOWS "leads to no BulletConfig.cmake")
foreach(precision float32 float64)
  expect_bullet(of_the_system_${precision} GOOD -D PRECISION=${precision} SHOWS "VERSION 3.[0-9]+")
endforeach()
