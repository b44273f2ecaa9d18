# Installs the packages of the lock file into WORK, beside the scripts that use them:
#   cmake -DSOURCE=readers -DWORK=folder -DNPM=npm -P install.cmake
# Without a network, the tests that need them are skipped.
file(GLOB files ${SOURCE}/*.mjs ${SOURCE}/*.json)
file(COPY ${files} DESTINATION ${WORK})
execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
  WORKING_DIRECTORY ${WORK} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT result EQUAL 0)
  message(WARNING "npm cannot install readers for tests, which will be skipped:\n${output}")
endif()
file(TOUCH ${WORK}/installed.txt)
