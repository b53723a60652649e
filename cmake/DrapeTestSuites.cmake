# drape_discover_suites(<target> PREFIX <name> [ENVIRONMENT <NAME=VALUE>...] [EACH] [GUEST])
#
# Adds one ctest for each suite of a GoogleTest program, so that the tests of a suite share a process and its device.
# EACH adds one for each test instead. Names are <name>.<suite>. Tests that tests/tiers.cmake lists as slow or timed get
# a ctest of their own for each suite, <name>.<suite>.slow and .timed. Labels are the name and the tier. The program is
# asked for its tests when ctest starts. GUEST puts all tests into the slow tier and adds none while the program has not
# been built.
function(drape_discover_suites target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "EACH;GUEST" "PREFIX" "ENVIRONMENT")
  set(script ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
  file(GENERATE OUTPUT ${script} CONTENT
    "set(cmake \"${CMAKE_COMMAND}\")
set(program \"$<TARGET_FILE:${target}>\")
set(emulator \"${CMAKE_CROSSCOMPILING_EMULATOR}\")
set(prefix \"${arg_PREFIX}\")
set(each ${arg_EACH})
set(guest ${arg_GUEST})
set(environment \"${arg_ENVIRONMENT}\")
include(\"${PROJECT_SOURCE_DIR}/tests/tiers.cmake\")
include(\"${PROJECT_SOURCE_DIR}/cmake/ListTestSuites.cmake\")
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${script})
endfunction()
