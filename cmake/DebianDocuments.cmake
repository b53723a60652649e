# Run by CPack before it makes a Debian package of each component: adds the copyright file and the changelog that
# Debian's policy asks for. The licence's own file goes, which the copyright file repeats.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
  return()
endif()
file(READ ${CPACK_RESOURCE_FILE_LICENSE} licence)
string(REGEX MATCH "Copyright[^\n]*" holder "${licence}")
string(REGEX REPLACE "^Copyright (\\(C\\) |\\(c\\) )?" "" holder "${holder}")
string(STRIP "${licence}" licence)
string(REGEX REPLACE "\n\n" "\n.\n" licence "${licence}")
string(REGEX REPLACE "\n" "\n " licence "${licence}")
set(version ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH, where it is set

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  file(GLOB_RECURSE licences ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${component}/*/LICENSE)
  if(licences)
    file(REMOVE ${licences})
  endif()
  set(folder ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${component}/usr/share/doc/${package})
  file(WRITE ${folder}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: Drape

Files: *
Copyright: ${holder}
License: Zlib
 ${licence}
")
  file(WRITE ${folder}/changelog.Debian "drape (${version}) unstable; urgency=medium

  * Release of Drape ${CPACK_PACKAGE_VERSION}; its CHANGELOG.md lists the changes.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
  execute_process(COMMAND gzip -9nf ${folder}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB_RECURSE documents ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${component}/usr/share/doc/*)
  file(CHMOD ${documents} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
endforeach()
