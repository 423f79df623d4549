# Writes the words of a SPIR-V file as a C array: cmake -DFILE=NAME.spv -DNAME=NAME -DOUT=NAME.h -P spirv_header.cmake.
file(READ ${FILE} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
string(REGEX REPLACE "(0x........,0x........,0x........,0x........,0x........,0x........,0x........,0x........,)" "\\1\n"
       words "${words}")
file(WRITE ${OUT} "#pragma once\n#include <cstdint>\nconst uint32_t ${NAME}[] = {\n${words}};\n")
