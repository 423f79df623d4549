# cmake -DFILE=NAME.spv -DDIS=spirv-dis -DAS=spirv-as -P uncontracted.cmake: decorates every sum, difference and product of
# a SPIR-V file, so that no device makes one rounding of two, and refuses what devices round each in its own way. GLSL's
# `precise` does the former too, variable by variable; here none can be forgotten.
execute_process(COMMAND ${DIS} --raw-id --no-color ${FILE} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
if(text MATCHES "Op(FDiv|FRem|FMod|Dot|[A-Za-z]*Times[A-Za-z]*|OuterProduct) "
   OR text MATCHES "OpExtInst %[0-9]+ %[0-9]+ ((Inverse)?Sqrt|Exp2?|Log2?|Pow|Fma|FMix|Length|Distance|Normalize|Sin|Cos|Tan|Atan2?)")
  message(FATAL_ERROR "${FILE} holds ${CMAKE_MATCH_0}, whose rounding differs between devices: see focus/arithmetic.glsl.")
endif()
string(REGEX MATCHALL "%[0-9]+ = Op(FAdd|FSub|FMul|FNegate) " operations "${text}")
list(TRANSFORM operations REPLACE "(%[0-9]+) = .*" "OpDecorate \\1 NoContraction\n" OUTPUT_VARIABLE decorations)
list(JOIN decorations "" decorations)
string(REGEX REPLACE "\n( *%[0-9]+ = OpTypeVoid\n)" "\n${decorations}\\1" decorated "${text}") # the first of the types
file(WRITE ${FILE}.spvasm "${decorated}")
execute_process(COMMAND ${AS} --target-env vulkan1.2 -o ${FILE} ${FILE}.spvasm COMMAND_ERROR_IS_FATAL ANY)
