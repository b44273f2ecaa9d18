# Helpers that every folder's CMakeLists.txt uses.

add_library(semigeo_options INTERFACE)
target_include_directories(semigeo_options INTERFACE ${PROJECT_SOURCE_DIR})
# Same bytes on every machine: no contraction of a*b+c, whatever the instruction set.
target_compile_options(semigeo_options INTERFACE
  -Wall -Wextra -Wshadow -ffp-contract=off -fno-math-errno)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # GCC 12 warns falsely about every string + "literal" (its bug 105651).
  target_compile_options(semigeo_options INTERFACE -Wno-restrict)
endif()
if(SEMIGEO_WARNINGS_AS_ERRORS)
  target_compile_options(semigeo_options INTERFACE -Werror)
endif()

# semigeo_layer(NAME SOURCES ... LINK ...): static library semigeo_NAME, alias semigeo::NAME.
function(semigeo_layer name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LINK")
  add_library(semigeo_${name} STATIC ${arg_SOURCES})
  add_library(semigeo::${name} ALIAS semigeo_${name})
  target_link_libraries(semigeo_${name} PUBLIC semigeo_options ${arg_LINK})
  # Not for tests, which mix literals freely.
  target_compile_options(semigeo_${name} PRIVATE -Wconversion -Wno-sign-conversion)
endfunction()
