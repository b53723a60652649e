# The test install.consumer installs Drape into WORK, then builds and runs examples/consumer against the installation.
#
# It builds once as a CMake package and once using pkg-config. It also compiles and runs every block of C++ and C in
# README.md and docs/*.md using pkg-config.
# Folders: BUILD (Drape's build), SOURCE (the consumer), DOCUMENTS (README.md and docs/), WORK (made anew), LIBDIR.
# Compilers: COMPILER, C_COMPILER, SANITIZE. Features: DOUBLE (the precision of Bullet that Drape is built for). With
# the Python module also PYTHON and PYTHON_DIR.
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

foreach(file LICENSE README.md CHANGELOG.md docs/using.md)
  if(NOT EXISTS ${prefix}/share/doc/Drape/${file})
    message(FATAL_ERROR "${file} is not installed with the documents")
  endif()
endforeach()
foreach(tool cloth_drop drape_check)
  if(EXISTS ${BUILD}/bin/${tool})
    must(${prefix}/bin/${tool} --version)
  endif()
endforeach()

must(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_CXX_COMPILER=${COMPILER}
  -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_FLAGS=${flags})
must(${CMAKE_COMMAND} --build ${WORK}/build)
must(${WORK}/build/consumer)
must(${WORK}/build/record ${WORK}/recorded)

set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
execute_process(COMMAND pkg-config --cflags --libs drape drape-recorder
  OUTPUT_VARIABLE package_flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(package_flags UNIX_COMMAND "${package_flags}")
must(${COMPILER} -std=c++11 ${flags} ${SOURCE}/main.cpp -o ${WORK}/consumer_by_pkg_config ${package_flags}
  -Wl,-rpath,${prefix}/${LIBDIR})
must(${WORK}/consumer_by_pkg_config)

# The recorder alone needs neither the plugin nor OpenCL.
execute_process(COMMAND pkg-config --cflags --libs drape-recorder
  OUTPUT_VARIABLE recorder_flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
if(recorder_flags MATCHES "-ldrape |OpenCL")
  message(FATAL_ERROR "The recorder asks for more than itself: ${recorder_flags}")
endif()
separate_arguments(recorder_flags UNIX_COMMAND "${recorder_flags}")
must(${COMPILER} -std=c++11 ${flags} ${SOURCE}/record.cpp -o ${WORK}/record_by_pkg_config ${recorder_flags}
  -Wl,-rpath,${prefix}/${LIBDIR})
must(${WORK}/record_by_pkg_config ${WORK}/recorded_by_pkg_config)

# Every header compiles as C++11.
file(GLOB headers RELATIVE ${prefix}/include ${prefix}/include/drape/*.h)
list(TRANSFORM headers REPLACE "(.+)" "#include <\\1>\n" OUTPUT_VARIABLE lines)
string(CONCAT lines ${lines})
file(WRITE ${WORK}/headers.cpp "${lines}")
must(${COMPILER} -std=c++11 ${flags} ${package_flags} -c ${WORK}/headers.cpp -o ${WORK}/headers.o)

# The Python package, where it was built.
if(PYTHON)
  must(${CMAKE_COMMAND} -E env PYTHONPATH=${prefix}/${PYTHON_DIR} ${PYTHON} -B -c
    "import drape; drape.ClothWorld(drape.Settings(backend='host')).step(); print(drape.__file__)")
endif()

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

# Every block of C++ or C in the documents must be a program that compiles as it stands, with nothing around it, and
# runs well.
set(opening "\n```[ ]*(cpp|c\\+\\+|C\\+\\+|cc|cxx|c|C)[ ]*\n")
set(count 0)
file(GLOB documents ${DOCUMENTS}/docs/*.md)
foreach(document ${DOCUMENTS}/README.md ${documents})
  file(READ ${document} text)
  cmake_path(GET document STEM name)
  set(${name}_count 0)
  string(REGEX MATCH "${opening}" fence "${text}")
  while(fence)
    set(language ${CMAKE_MATCH_1})
    string(FIND "${text}" "${fence}" begin)
    string(LENGTH "${fence}" length)
    math(EXPR begin "${begin} + ${length}")
    string(SUBSTRING "${text}" ${begin} -1 text)
    string(FIND "${text}" "\n```" end)
    if(end EQUAL -1)
      message(FATAL_ERROR "A block of ${language} in ${document} does not end")
    endif()
    math(EXPR next "${end} + 4")
    string(SUBSTRING "${text}" 0 ${end} block)
    string(SUBSTRING "${text}" ${next} -1 text)
    math(EXPR count "${count} + 1")
    math(EXPR ${name}_count "${${name}_count} + 1")
    set(program ${WORK}/${name}_${${name}_count})
    if(language MATCHES "^[cC]$")
      file(WRITE ${program}.c "${block}\n")
      must(${C_COMPILER} -std=c99 -Wall -Wextra -pedantic -Werror ${flags} ${program}.c -o ${program} ${package_flags}
        -lstdc++ -lm -Wl,-rpath,${prefix}/${LIBDIR})
    else()
      file(WRITE ${program}.cpp "${block}\n")
      must(${COMPILER} -std=c++11 ${flags} ${program}.cpp -o ${program} ${package_flags}
        -Wl,-rpath,${prefix}/${LIBDIR})
    endif()
    execute_process(COMMAND ${program} OUTPUT_VARIABLE ${name}_${${name}_count} COMMAND_ERROR_IS_FATAL ANY)
    message("${${name}_${${name}_count}}")
    string(REGEX MATCH "${opening}" fence "${text}")
  endwhile()
endforeach()
if(NOT README_1 MATCHES "^Drape on .* ([1-9][0-9]*) contacts" OR NOT README_1 MATCHES "\nDrape handles the pair\n$")
  message(FATAL_ERROR "The README's program does not report contacts of a pair that Drape handles")
endif()
if(NOT queries_1 MATCHES "^1 near, 1 intersecting\nhit at 0\\.[45]")
  message(FATAL_ERROR "The program of docs/queries.md does not find the pair that meets")
endif()
if(NOT c_1 MATCHES "^[1-9][0-9]* contacts, node 0 at 0\\.0[12][0-9] m, good")
  message(FATAL_ERROR "The program of docs/c.md does not find contacts")
endif()
if(NOT seeing_contacts_1 MATCHES "^the ground carries (1\\.9[5-9]|2\\.0[0-5]) kg")
  message(FATAL_ERROR "The impulses of docs/seeing_contacts.md do not hold the cloth")
endif()
if(NOT using_1 MATCHES "^step: good\nDrape handles the pair\n")
  message(FATAL_ERROR "The program of docs/using.md does not run with Drape")
endif()
