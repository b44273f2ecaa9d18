# Makes the pages of the report and writes them as a C++ source:
#   cmake -DSOURCE=report -DWORK=folder -DOUTPUT=pages.cpp -DNODE=node -DNPM=npm -DREQUIRED=ON -P build.cmake
# The packages are installed into WORK, so nothing appears beside the sources. If they cannot be
# installed and the report is not REQUIRED, the source says why there is none.
cmake_minimum_required(VERSION 3.25)

file(MAKE_DIRECTORY ${WORK})
file(SHA256 ${SOURCE}/package-lock.json wanted)
set(installed "")
if(EXISTS ${WORK}/installed.txt)
  file(READ ${WORK}/installed.txt installed)
endif()
if(NOT installed STREQUAL wanted)
  file(REMOVE ${WORK}/installed.txt)
  file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json DESTINATION ${WORK})
  # No package runs a script of its own.
  execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
    WORKING_DIRECTORY ${WORK} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    if(REQUIRED)
      message(FATAL_ERROR "npm cannot install the packages of the report:\n${output}")
    endif()
    message(WARNING "The program gets no report, because npm cannot install its packages:\n${output}")
    set(REASON "npm could not install the packages of the report when the program was built")
    configure_file(${SOURCE}/no_pages.cpp.in ${OUTPUT} @ONLY)
    return()
  endif()
  file(WRITE ${WORK}/installed.txt ${wanted})
endif()

file(REMOVE_RECURSE ${WORK}/src)
file(COPY ${SOURCE}/src ${SOURCE}/tsconfig.json ${SOURCE}/build.mjs DESTINATION ${WORK})
foreach(step "node_modules/typescript/bin/tsc;--project;tsconfig.json" "build.mjs;${OUTPUT}")
  execute_process(COMMAND ${NODE} ${step} WORKING_DIRECTORY ${WORK} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
