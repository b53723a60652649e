# The test install.consumer: installs Drape into WORK, then builds and runs examples/consumer against what was
# installed, once as a CMake package and once by pkg-config.
# Input: BUILD (Drape's build folder), SOURCE (the consumer), WORK (made anew), LIBDIR, COMPILER, SANITIZE.
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
execute_process(COMMAND pkg-config --static --cflags --libs drape
  OUTPUT_VARIABLE package_flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(package_flags UNIX_COMMAND "${package_flags}")
must(${COMPILER} -std=c++11 ${flags} ${SOURCE}/main.cpp -o ${WORK}/consumer_by_pkg_config ${package_flags}
  -Wl,-rpath,${prefix}/${LIBDIR})
must(${WORK}/consumer_by_pkg_config)
