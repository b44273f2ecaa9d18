# Fails if the program loads a library of the network. Nothing here uses one; they would come with a
# dependency, take milliseconds at each start, and be one more thing to trust.
execute_process(COMMAND ldd ${PROGRAM} OUTPUT_VARIABLE loaded COMMAND_ERROR_IS_FATAL ANY)
if(NOT loaded MATCHES "libc[.]so")
  message(FATAL_ERROR "ldd says nothing about ${PROGRAM}")
endif()
string(REGEX MATCHALL "lib(curl|ssl|crypto|gnutls|krb5|ldap|ssh2|nghttp2)[-.0-9]*[.]so" found "${loaded}")
if(found)
  message(FATAL_ERROR "${PROGRAM} loads ${found} (a build folder keeps its first choice of HDF5: remove CMakeCache.txt)")
endif()
