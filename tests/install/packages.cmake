# The test install.packages makes the archive and the Debian packages of a build and looks into them. The programs run
# from the unpacked packages.
# Input: BUILD (Drape's build folder), WORK (made anew), VERSION, SHARED (the build has shared libraries), TOOLS (it has
# tools). Needs dpkg-deb and dpkg-shlibdeps; without them only the archive is checked. Lintian looks at the packages
# where it is installed.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK})
get_filename_component(bin ${CMAKE_COMMAND} DIRECTORY)
function(must)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
endfunction()

# Fails unless each pattern matches a file of the list, given relative to the folder that was unpacked.
function(must_have name folder)
  file(GLOB_RECURSE files RELATIVE ${folder} ${folder}/*)
  foreach(pattern IN LISTS ARGN)
    set(found ${files})
    list(FILTER found INCLUDE REGEX "^${pattern}$")
    if(NOT found)
      list(JOIN files "\n" files)
      message(FATAL_ERROR "${name} has no ${pattern}:\n${files}")
    endif()
  endforeach()
endfunction()

# Runs an installed program with --version.
function(must_run program)
  execute_process(COMMAND ${program} --version OUTPUT_VARIABLE version COMMAND_ERROR_IS_FATAL ANY)
  if(NOT version MATCHES "${VERSION}")
    message(FATAL_ERROR "${program} --version says: ${version}")
  endif()
  must(${program} --help)
endfunction()

set(library "")
set(archived lib/libdrape\\.a lib/libdrape_recorder\\.a)
if(SHARED)
  string(REGEX MATCH "^[0-9]+\\.[0-9]+" soversion ${VERSION})
  set(library libdrape${soversion})
  set(archived lib/libdrape\\.so.* lib/libdrape_recorder\\.so.*)
endif()
set(development usr/include/drape/drape\\.h usr/include/drape/export\\.h usr/include/drape/recorder\\.h
  usr/lib/.*cmake/Drape/DrapeConfig\\.cmake usr/lib/.*pkgconfig/drape\\.pc usr/share/doc/libdrape-dev/copyright
  usr/share/doc/libdrape-dev/changelog\\.Debian\\.gz usr/share/doc/Drape/CHANGELOG\\.md
  usr/share/doc/Drape/docs/using\\.md)

must(${bin}/cpack --config ${BUILD}/CPackConfig.cmake -G TGZ -B ${WORK}/tgz)
file(GLOB archive ${WORK}/tgz/drape-${VERSION}-*.tar.gz)
must(${CMAKE_COMMAND} -E make_directory ${WORK}/unpacked)
must(tar -C ${WORK}/unpacked --strip-components 1 -xzf ${archive})
must_have("The archive" ${WORK}/unpacked include/drape/drape\\.h share/doc/Drape/LICENSE share/doc/Drape/README\\.md
  ${archived})
if(TOOLS)
  must_run(${WORK}/unpacked/bin/cloth_drop)
  must_run(${WORK}/unpacked/bin/drape_check)
endif()

find_program(dpkg_deb dpkg-deb)
find_program(dpkg_shlibdeps dpkg-shlibdeps)
if(NOT dpkg_deb OR NOT dpkg_shlibdeps)
  return()
endif()
must(${bin}/cpack --config ${BUILD}/CPackConfig.cmake -G DEB -B ${WORK}/deb)

# Unpacks a package into a folder of its name and checks what it depends on.
function(unpack package depends)
  file(GLOB file ${WORK}/deb/${package}_${VERSION}-1_*.deb)
  if(NOT file)
    message(FATAL_ERROR "CPack made no ${package}")
  endif()
  must(dpkg-deb -x ${file} ${WORK}/${package})
  execute_process(COMMAND dpkg-deb -f ${file} Depends OUTPUT_VARIABLE found COMMAND_ERROR_IS_FATAL ANY)
  if(NOT found MATCHES "${depends}")
    message(FATAL_ERROR "${package} does not depend on ${depends}, but on ${found}")
  endif()
endfunction()

unpack(libdrape-dev "libbullet-dev \\(>= 3.24\\).*${library}")
must_have(libdrape-dev ${WORK}/libdrape-dev ${development})
if(TOOLS)
  unpack(drape-tools "libbullet.*libc6|libc6.*libbullet")
  must_have(drape-tools ${WORK}/drape-tools usr/share/doc/drape-tools/copyright
    "usr/share/man/man1/cloth_drop\\.1(\\.gz)?" usr/share/bash-completion/completions/cloth_drop
    usr/share/drape/docs/scene\\.schema\\.json usr/share/drape/examples/scenes/table\\.json)
  must_run(${WORK}/drape-tools/usr/bin/cloth_drop)
  must_run(${WORK}/drape-tools/usr/bin/drape_check)
endif()
if(SHARED)
  unpack(${library} "libbullet")
  must_have(${library} ${WORK}/${library} usr/lib/.*libdrape\\.so\\.${VERSION}
    usr/lib/.*libdrape_recorder\\.so\\.${VERSION} usr/share/doc/${library}/copyright)
endif()
file(GLOB packages ${WORK}/deb/*.deb)
list(LENGTH packages count)
message("${count} packages")
find_program(lintian lintian)
if(lintian)
  # CPACK_PACKAGE_CONTACT names the maintainer of packages that others get.
  must(${lintian} --allow-root --fail-on error
    --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog ${packages})
endif()
