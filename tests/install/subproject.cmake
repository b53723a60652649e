# The test install.subproject configures an app that has Drape in its own tree: nothing of Drape is installed with the
# app, unless DRAPE_INSTALL asks for it.
# Input: SOURCE (Drape's folder), WORK (made anew), COMPILER, GENERATOR.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK})
file(WRITE ${WORK}/app/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(App LANGUAGES CXX)
add_subdirectory(${SOURCE} drape)
add_executable(app main.cpp)
target_link_libraries(app PRIVATE Drape::drape)
install(TARGETS app)
")
file(WRITE ${WORK}/app/main.cpp "int main() {}\n")

# Sets `result` to the rules that install something of Drape's.
function(rules_of_drape result)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK}/app -B ${WORK}/build -G ${GENERATOR} -D CMAKE_BUILD_TYPE=Release
    -D CMAKE_CXX_COMPILER=${COMPILER} ${ARGN} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB_RECURSE scripts ${WORK}/build/drape/cmake_install.cmake ${WORK}/build/drape/*/cmake_install.cmake)
  set(rules "")
  foreach(script IN LISTS scripts)
    file(STRINGS ${script} lines REGEX "file\\(INSTALL ")
    list(APPEND rules ${lines})
  endforeach()
  set(${result} "${rules}" PARENT_SCOPE)
endfunction()

rules_of_drape(rules)
if(rules)
  list(JOIN rules "\n" rules)
  message(FATAL_ERROR "An app that has Drape in its tree would install this with itself:\n${rules}")
endif()
rules_of_drape(rules -D DRAPE_INSTALL=ON)
if(NOT rules MATCHES "libdrape\\.")
  message(FATAL_ERROR "DRAPE_INSTALL=ON does not install the library:\n${rules}")
endif()
