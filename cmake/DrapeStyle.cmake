# Adds the tests of the house style. `style` reads every tracked file, `style.checker` tests the reader, `style.tiers`
# checks the names in tests/tiers.cmake, and `style.format` the layout of C++ and OpenCL C.
find_package(Python3 3.7 COMPONENTS Interpreter)
find_program(DRAPE_GIT git)
find_program(DRAPE_CLANG_FORMAT NAMES clang-format-14 clang-format)
mark_as_advanced(DRAPE_GIT DRAPE_CLANG_FORMAT)

# Other versions lay out some lines differently; Debian 12 has 14.
if(DRAPE_GIT AND DRAPE_CLANG_FORMAT AND EXISTS ${PROJECT_SOURCE_DIR}/.git)
  execute_process(COMMAND ${DRAPE_CLANG_FORMAT} --version OUTPUT_VARIABLE version)
  if(version MATCHES "version 14\\.")
    add_test(NAME style.format
      COMMAND bash ${PROJECT_SOURCE_DIR}/tools/format.sh --check ${DRAPE_CLANG_FORMAT})
    set_tests_properties(style.format PROPERTIES TIMEOUT 60 LABELS fast)
  endif()
endif()

if(Python3_Interpreter_FOUND AND DRAPE_GIT)
  if(EXISTS ${PROJECT_SOURCE_DIR}/.git)
    add_test(NAME style COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/tools/check_style.py)
    set_tests_properties(style PROPERTIES TIMEOUT 60 LABELS fast)
  endif()
  add_test(NAME style.checker
    COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/tests/style/check_style_test.py ${PROJECT_SOURCE_DIR}/tools)
  set_tests_properties(style.checker PROPERTIES TIMEOUT 60 LABELS fast)
  add_test(NAME style.tiers
    COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/tests/style/tiers_test.py ${PROJECT_SOURCE_DIR})
  set_tests_properties(style.tiers PROPERTIES TIMEOUT 60 LABELS fast)
endif()
