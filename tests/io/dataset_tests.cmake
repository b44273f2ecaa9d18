# The dataset's tests: in C++, and once more by HDF5's own filters through h5py.
add_library(semigeo_sample_dataset STATIC sample_dataset.cpp)
target_link_libraries(semigeo_sample_dataset PUBLIC semigeo::io)

semigeo_tests(io_dataset_tests
  LABEL unit
  SOURCES
    atomic_file_test.cpp
    chunk_codec_test.cpp
    dataset_test.cpp
    feature_tables_test.cpp
    hdf5_test.cpp
    selection_test.cpp
    utf8_test.cpp
    vtkhdf_test.cpp
    xdmf_test.cpp
  LINK semigeo_sample_dataset)

add_executable(write_sample_dataset write_sample_dataset.cpp)
target_link_libraries(write_sample_dataset PRIVATE semigeo_sample_dataset)

# Debian's interpreter, the one that python3-h5py belongs to, whatever else is on the PATH.
find_program(SEMIGEO_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
add_test(NAME io.dataset_h5py
  COMMAND ${SEMIGEO_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/dataset_h5py_test.py
          $<TARGET_FILE:write_sample_dataset>)
set_tests_properties(io.dataset_h5py PROPERTIES LABELS unit TIMEOUT 120)
