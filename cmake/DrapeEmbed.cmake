# drape_embed_kernels(<target> <name> <output variable> <files>...): the files' texts, relative to the project, as a C++
# source that defines the list <name>s and its length <name>Count. The source is made again when a file changes, and
# <target> makes it.
function(drape_embed_kernels target name output)
  set(files ${ARGN})
  list(SORT files)
  # The list is a file, written only when it differs: so both make and ninja notice a file that was removed.
  set(list_file ${CMAKE_CURRENT_BINARY_DIR}/${target}_files.txt)
  list(JOIN files "\n" list_text)
  file(CONFIGURE OUTPUT ${list_file} CONTENT "${list_text}\n" @ONLY)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp)
  set(script ${PROJECT_SOURCE_DIR}/cmake/EmbedKernels.cmake)
  list(TRANSFORM files PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE paths)
  add_custom_command(
    OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR} -D LIST=${list_file} -D OUTPUT=${source} -D NAME=${name}
      -P ${script}
    DEPENDS ${paths} ${list_file} ${script}
    COMMENT "Embedding kernels"
    VERBATIM)
  add_custom_target(${target} DEPENDS ${source})
  set(${output} ${source} PARENT_SCOPE)
endfunction()
