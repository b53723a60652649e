# drape_command_pages(<target>)
#
# Makes a man page and the completions of bash, zsh and fish of a program from its options, and installs them beside it
# unless DRAPE_INSTALL is off. The program runs at build time: nothing is made when cross-compiling without an emulator,
# or with sanitizers.
include(GNUInstallDirs)

function(drape_command_pages target)
  if(DRAPE_SANITIZE OR (CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR))
    return()
  endif()
  set(folder ${PROJECT_BINARY_DIR}/pages)
  file(MAKE_DIRECTORY ${folder})
  set(pages ${folder}/${target}.1 ${folder}/${target}.bash ${folder}/_${target} ${folder}/${target}.fish)
  list(GET pages 0 man)
  list(GET pages 1 bash)
  list(GET pages 2 zsh)
  list(GET pages 3 fish)
  # They are made with the program, so that an install finds them whatever target was built.
  add_custom_command(TARGET ${target} POST_BUILD BYPRODUCTS ${pages}
    COMMAND ${target} --man-page > ${man}
    COMMAND ${target} --completion bash > ${bash}
    COMMAND ${target} --completion zsh > ${zsh}
    COMMAND ${target} --completion fish > ${fish}
    COMMENT "Making the man page and completions of ${target}"
    VERBATIM)
  if(DEFINED DRAPE_INSTALL AND NOT DRAPE_INSTALL)
    return()
  endif()
  install(FILES ${man} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
  install(FILES ${bash} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${target}
    COMPONENT tools)
  install(FILES ${zsh} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT tools)
  install(FILES ${fish} DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT tools)
endfunction()
