# Writes files as a C++ source: cmake -D ROOT=dir -D LIST=file -D OUTPUT=file -D NAME=name -P EmbedKernels.cmake
#
# LIST names one file a line, relative to ROOT; OUTPUT defines the
# list <NAME>s of core/device/embedded_kernels.h and its length <NAME>Count. Texts are
# written as character values, so any content and any size is safe; a zero byte is refused, because texts end with one.
cmake_minimum_required(VERSION 3.25)
file(STRINGS ${LIST} files)
set(texts "")
set(table "")
set(index 0)
foreach(name IN LISTS files)
  file(READ ${ROOT}/${name} bytes HEX)
  string(REGEX REPLACE "(..)" "\\1;" pairs "${bytes}")
  if("00" IN_LIST pairs)
    message(FATAL_ERROR "${ROOT}/${name} contains a zero byte")
  endif()
  # 24 values a line are short enough for any editor and compiler.
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," values "${bytes}")
  string(REPEAT "......." 24 line)
  string(REGEX REPLACE "(${line})" "\\1\n" values "${values}")
  string(APPEND texts "// ${name}\nconst char kText${index}[] = {\n${values}'\\0'};\n\n")
  string(APPEND table "    {\"${name}\", kText${index}},\n")
  math(EXPR index "${index} + 1")
endforeach()
if(index EQUAL 0)
  message(FATAL_ERROR "${LIST} names no kernel file")
endif()

file(WRITE ${OUTPUT}.part
"// Made by cmake/EmbedKernels.cmake. Do not edit.
#include \"bullet_plugin/core/device/embedded_kernels.h\"

namespace
{
${texts}}  // namespace

namespace drape
{
extern const EmbeddedFile ${NAME}s[];
extern const std::size_t ${NAME}Count;
const EmbeddedFile ${NAME}s[] = {
${table}};
const std::size_t ${NAME}Count = ${index};
}  // namespace drape
")
file(RENAME ${OUTPUT}.part ${OUTPUT})
