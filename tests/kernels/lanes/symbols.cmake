# The source of an instruction set defines one external function, its own. Any other, an inline one
# for example, might be the copy that the linker keeps for the whole program, which would then crash
# on a CPU without that instruction set.
#   cmake -DNM=<nm> -DSET=avx2 "-DOBJECTS=<objects of kernels>" -P symbols.cmake
cmake_minimum_required(VERSION 3.25)
list(FILTER OBJECTS INCLUDE REGEX "/block_${SET}[.]cpp")
list(LENGTH OBJECTS count)
if(NOT count EQUAL 1)
  message(FATAL_ERROR "${count} objects of block_${SET}.cpp instead of one")
endif()
execute_process(COMMAND ${NM} --extern-only --defined-only --demangle ${OBJECTS}
  OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" symbols "${symbols}")
set(foreign ${symbols})
list(FILTER foreign EXCLUDE REGEX " T semigeo::kernels::${SET}::trace_block")
list(LENGTH symbols count)
if(foreign OR NOT count EQUAL 1)
  message(FATAL_ERROR "block_${SET}.cpp must define trace_block only, but defines\n${symbols}")
endif()
