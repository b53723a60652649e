# The test install.consumer: installs Drape into WORK, then builds and runs examples/consumer against what was
# installed, once as a CMake package and once by pkg-config; by pkg-config also the README's program, which it runs, and
# its fragment, which it compiles.
# Input: BUILD (Drape's build folder), SOURCE (the consumer), README, WORK (made anew), LIBDIR, COMPILER, SANITIZE,
# DOUBLE (the precision of Bullet that Drape is built for).
cmake_minimum_required(VERSION 3.25)
function(must)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(flags "")
if(SANITIZE)
  set(flags -fsanitize=address,undefined)
endif()
set(prefix ${WORK}/prefix)
file(REMOVE_RECURSE ${WORK})
must(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})

must(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_CXX_COMPILER=${COMPILER}
  -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_FLAGS=${flags})
must(${CMAKE_COMMAND} --build ${WORK}/build)
must(${WORK}/build/consumer)

set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
execute_process(COMMAND pkg-config --cflags --libs drape
  OUTPUT_VARIABLE package_flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(package_flags UNIX_COMMAND "${package_flags}")
must(${COMPILER} -std=c++11 ${flags} ${SOURCE}/main.cpp -o ${WORK}/consumer_by_pkg_config ${package_flags}
  -Wl,-rpath,${prefix}/${LIBDIR})
must(${WORK}/consumer_by_pkg_config)

# An app in the other precision: told by the compiler where it has the package's flags, else by the linker.
set(other -DBT_USE_DOUBLE_PRECISION)
if(DOUBLE)
  set(other -UBT_USE_DOUBLE_PRECISION)
endif()
file(WRITE ${WORK}/other_precision.cpp "#include <drape/plugin.h>\nint main() { drape::Plugin plugin; }\n")
foreach(stage "is built for Bullet in" "drapeIsBuiltForBulletIn(Double|Single)Precision")
  execute_process(COMMAND ${COMPILER} -std=c++11 ${flags} ${WORK}/other_precision.cpp -o ${WORK}/other_precision
      ${package_flags} ${other} COMMAND_ECHO STDOUT
    OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(result EQUAL 0 OR NOT output MATCHES "${stage}")
    message(FATAL_ERROR "An app in the other precision is not told so:\n${output}")
  endif()
  list(APPEND other -UDRAPE_BULLET_DOUBLE)
endforeach()

# Blocks of C++ in the order in which the README has them; semicolons would part a list.
file(READ ${README} text)
string(REPLACE ";" "@semicolon@" text "${text}")
string(REGEX MATCHALL "```cpp\n[^`]*```" blocks "${text}")
list(LENGTH blocks count)
if(NOT count EQUAL 2)
  message(FATAL_ERROR "The README has ${count} blocks of C++, of which this test knows two")
endif()
set(sources "")
foreach(block IN LISTS blocks)
  string(REGEX REPLACE "^```cpp\n(.*)```$" "\\1" block "${block}")
  list(APPEND sources "${block}")
endforeach()
list(GET sources 0 program)
list(GET sources 1 fragment)
string(REGEX MATCHALL "#include [^\n]*" includes "${fragment}")
string(REGEX REPLACE "#include [^\n]*" "" fragment "${fragment}")
list(JOIN includes "\n" includes)
set(fragment "${includes}
void ask(const drape::MeshDescription& meshA, const drape::MeshDescription& meshB, const drape::CcdQuery& ccdQuery)
{
${fragment}
}
")
foreach(name program fragment)
  string(REPLACE "@semicolon@" ";" ${name} "${${name}}")
  file(WRITE ${WORK}/readme_${name}.cpp "${${name}}")
endforeach()
must(${COMPILER} -std=c++11 -fsyntax-only ${WORK}/readme_fragment.cpp ${package_flags})
must(${COMPILER} -std=c++11 ${flags} ${WORK}/readme_program.cpp -o ${WORK}/readme_program ${package_flags}
  -Wl,-rpath,${prefix}/${LIBDIR})
execute_process(COMMAND ${WORK}/readme_program OUTPUT_VARIABLE report COMMAND_ERROR_IS_FATAL ANY)
message("${report}")
if(NOT report MATCHES "^Drape on .* ([1-9][0-9]*) contacts" OR NOT report MATCHES "\n\n$")
  message(FATAL_ERROR "The README's program does not report contacts of a pair that Drape has")
endif()
