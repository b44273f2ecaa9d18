# What is printed for people: only few files print, so that every name passes io::printable, and no
# pattern of printf cuts the digits of a number (io::number_text and io::fixed_text write them).
#   cmake -DROOT=<repository> -P printing.cmake
cmake_minimum_required(VERSION 3.25)

# Files that may print, each with the reason.
set(printers
  jobs/cli/output.cpp        # prints for all commands
  jobs/cli/options_page.cpp  # prints words of the program alone
  jobs/cli/bench.cpp         # prints words of the program alone
  jobs/run/progress.cpp      # prints what io::printable has returned
  jobs/run/worker.cpp        # prints into the log of a job
  io/files/output_file.cpp)  # writes files
# Folders and files whose numbers are rates and spreads of measurements.
set(measurements "^jobs/bench/|^jobs/cli/bench.cpp$")

set(violations 0)
function(complain text)
  message("${text}")
  math(EXPR violations "${violations} + 1")
  set(violations "${violations}" PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE sources RELATIVE "${ROOT}" "${ROOT}/engine/*.?pp" "${ROOT}/kernels/*.?pp"
  "${ROOT}/io/*.?pp" "${ROOT}/jobs/*.?pp")
if(NOT sources)
  message(FATAL_ERROR "no sources in ${ROOT}")
endif()
foreach(source ${sources})
  if(NOT source IN_LIST printers)
    file(STRINGS "${ROOT}/${source}" lines
      REGEX "(^|[^a-z_])(f?printf|f?puts|fwrite|putchar) *\\(|std::(cout|cerr|clog)")
    foreach(line ${lines})
      complain("${source}: ${line}: print with jobs/cli/output.hpp")
    endforeach()
  endif()
  if(NOT source MATCHES "${measurements}")
    file(STRINGS "${ROOT}/${source}" lines REGEX "\"[^\"]*%[-+#0-9.*]*L?[efgEFG][^\"]*\"|std::set(precision|w)")
    foreach(line ${lines})
      complain("${source}: ${line}: write numbers with io/files/number_text.hpp")
    endforeach()
  endif()
endforeach()
if(violations GREATER 0)
  message(FATAL_ERROR "${violations} lines print past the functions that print for people")
endif()
