# Run with -P: writes HEADER with a hash of the contents of FILES.
set(sums)
foreach(file ${FILES})
  file(SHA256 ${file} sum)
  string(APPEND sums ${sum})
endforeach()
string(SHA256 hash "${sums}")
string(SUBSTRING ${hash} 0 16 hash)
file(WRITE ${HEADER}
"#pragma once

namespace q3rt {

inline constexpr const char* kShaderHash = \"${hash}\";

} // namespace q3rt
")
