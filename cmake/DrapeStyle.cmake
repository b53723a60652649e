# Adds the tests of the house style. `style` reads every tracked file, `style.checker` tests the reader, and `style.tiers`
# checks the names in tests/tiers.cmake.
find_package(Python3 3.7 COMPONENTS Interpreter)
find_program(DRAPE_GIT git)
mark_as_advanced(DRAPE_GIT)
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
