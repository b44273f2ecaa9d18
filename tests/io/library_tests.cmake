# The tests of a library and of what it is built from: in C++, and once more through h5py.
add_library(semigeo_sample_library STATIC sample_library.cpp)
target_link_libraries(semigeo_sample_library PUBLIC semigeo::io semigeo_shapes)

semigeo_tests(io_library_tests
  LABEL unit
  SOURCES
    hash_library_test.cpp
    packed_normal_test.cpp
    posting_partition_test.cpp
    triplet_run_test.cpp
  LINK semigeo_sample_library)

add_executable(write_sample_library write_sample_library.cpp)
target_link_libraries(write_sample_library PRIVATE semigeo_sample_library)
add_test(NAME io.library_h5py
  COMMAND ${SEMIGEO_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/library_h5py_test.py
          $<TARGET_FILE:write_sample_library>)
set_tests_properties(io.library_h5py PROPERTIES LABELS unit TIMEOUT 120)
