semigeo_tests(io_reader_tests LABEL unit
  SOURCES
    byte_source_test.cpp
    decimal_test.cpp
    feature_writer_test.cpp
    file_digest_test.cpp
    mesh_writer_test.cpp
    obj_reader_test.cpp
    off_reader_test.cpp
    ply_reader_test.cpp
    polygon_triangulator_test.cpp
    scan_reader_test.cpp
    stl_reader_test.cpp
    text_scanner_test.cpp
  LINK semigeo::io)

# A program of its own: it replaces operator new.
semigeo_tests(io_reader_fuzz_tests LABEL unit
  SOURCES scan_reader_fuzz_test.cpp
  LINK semigeo::io)
