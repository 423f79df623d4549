# Writes the first 16 digits of the SHA-256 of the files' own SHA-256, in order of name: cmake -DFILES=...
# -DOUT=digest.h -P digest.cmake.
list(SORT FILES)
set(sums "")
foreach(file ${FILES})
  file(SHA256 ${file} sum)
  get_filename_component(name ${file} NAME)
  string(APPEND sums "${name} ${sum}\n")
endforeach()
string(SHA256 sum "${sums}")
string(SUBSTRING ${sum} 0 16 sum)
file(WRITE ${OUT} "inline constexpr const char* spirv_digest = \"${sum}\";\n")
