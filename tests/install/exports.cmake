# Adds the tests of what shared libraries and the Python module export. A static build links shared libraries of the
# same objects for them. Only ELF's symbol tables are read.
if(NOT UNIX OR APPLE OR NOT Python3_FOUND)
  return()
endif()

# drape_test_exports(<kind> <target>): see exported_symbols.py.
function(drape_test_exports kind target)
  add_test(NAME install.exports_${kind} COMMAND ${Python3_EXECUTABLE} -B
    ${PROJECT_SOURCE_DIR}/tests/install/exported_symbols.py ${kind} $<TARGET_FILE:${target}>)
  set_tests_properties(install.exports_${kind} PROPERTIES TIMEOUT 60 LABELS "install;fast")
endfunction()

# drape_shared_twin(<name> <objects>...): a shared library of a static one's objects, linked as a shared build does.
function(drape_shared_twin name)
  add_library(${name} SHARED ${ARGN})
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/exports)
  drape_export_only(${name} ${DRAPE_EXPORTED_NAMES})
  if(DRAPE_SANITIZE)
    target_link_options(${name} PRIVATE -fsanitize=address,undefined)
  endif()
endfunction()

if(BUILD_SHARED_LIBS)
  drape_test_exports(library drape)
  drape_test_exports(recorder drape_recorder)
else()
  drape_shared_twin(drape_shared $<TARGET_OBJECTS:drape> $<TARGET_OBJECTS:drape_core>)
  target_link_libraries(drape_shared PRIVATE DrapeBullet::bullet Threads::Threads ${CMAKE_DL_LIBS})
  drape_test_exports(library drape_shared)
  drape_shared_twin(drape_shared_recorder $<TARGET_OBJECTS:drape_recorder>)
  target_link_libraries(drape_shared_recorder PRIVATE DrapeBullet::bullet ZLIB::ZLIB)
  drape_test_exports(recorder drape_shared_recorder)
endif()
if(DRAPE_WITH_PYTHON)
  drape_test_exports(python drape_python)
endif()
