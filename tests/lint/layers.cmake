# Who may include whom: the order of the layers and of the folders in them, over the includes of
# every source. It says what a folder may include when one breaks the order.
#   cmake -DROOT=<repository> -P layers.cmake
cmake_minimum_required(VERSION 3.25)

# Folders, each with the folders that it may include besides itself. Those of other layers are
# named by their layer.
set(rules
  "engine:"

  "kernels/surface:"
  "kernels/repair: kernels/surface"
  "kernels/patch: kernels/surface"
  "kernels/evolution: kernels/surface kernels/patch"
  "kernels/lanes: kernels/surface kernels/patch kernels/evolution"
  "kernels/features: kernels/surface kernels/patch"
  "kernels/recognition: kernels/surface kernels/features"
  "kernels/recognition/thesis: kernels/surface kernels/features kernels/recognition"

  "io/files:"
  "io/scans: kernels io/files"
  "io/hdf5: io/files"
  "io/dataset: kernels io/files io/hdf5"
  "io/library: kernels io/files io/hdf5"

  "jobs/archive: engine kernels io"
  "jobs/stages: engine kernels io"
  "jobs/picture: engine kernels io"
  "jobs/report: engine kernels io jobs/archive jobs/picture jobs/stages"
  "jobs/plan: engine kernels io jobs/archive"
  "jobs/run: engine kernels io jobs/archive jobs/plan"
  "jobs/slurm: engine kernels io jobs/archive jobs/plan jobs/run"
  "jobs/kinds: engine kernels io jobs/archive jobs/plan jobs/stages jobs/report"
  "jobs/bench: engine kernels io jobs/archive jobs/plan jobs/run jobs/stages"
  "jobs/cli: engine kernels io jobs/archive jobs/plan jobs/run jobs/slurm jobs/kinds jobs/stages jobs/bench jobs/picture jobs/report")

# Single headers that a layer may include besides.
# Who owns a file descriptor is decided once, for engine, io and jobs.
set(exceptions "io:engine/descriptor.hpp")

# Libraries, each with the one folder or layer that may include its headers.
set(libraries "tbb/:engine" "nanoflann:kernels" "hdf5.h:io/hdf5" "zlib.h:io" "archive.h:io/files"
  "archive_entry.h:io/files" "libdeflate.h:io"
  "xxhash.h:io" "pugixml:io" "draco/:io" "png.h:io/files" "ft2build.h:jobs/picture" "CLI/:jobs/cli")
# Tests and benchmarks only: they make meshes that are none of ours.
list(APPEND libraries "OpenMesh/:none")

set(violations 0)
function(complain text)
  message("${text}")
  math(EXPR violations "${violations} + 1")
  set(violations "${violations}" PARENT_SCOPE)
endfunction()

set(folders "")
foreach(rule ${rules})
  string(REGEX MATCH "^([^:]+):(.*)$" matched "${rule}")
  set(folder "${CMAKE_MATCH_1}")
  string(STRIP "${CMAKE_MATCH_2}" may)
  string(REPLACE " " ";" may_${folder} "${may}")
  list(APPEND folders "${folder}")
endforeach()

file(GLOB_RECURSE sources RELATIVE "${ROOT}" "${ROOT}/engine/*.?pp" "${ROOT}/kernels/*.?pp"
  "${ROOT}/io/*.?pp" "${ROOT}/jobs/*.?pp")
if(NOT sources)
  message(FATAL_ERROR "no sources in ${ROOT}")
endif()

foreach(source ${sources})
  cmake_path(GET source PARENT_PATH folder)
  string(REGEX MATCH "^[^/]*" own "${folder}")
  if(NOT folder IN_LIST folders)
    complain("${source}: ${folder} has no place in the order of folders: give it one in layers.cmake")
    continue()
  endif()
  file(STRINGS "${ROOT}/${source}" includes REGEX "^ *# *include")
  foreach(line ${includes})
    if(line MATCHES "\"([^\"]+)\"")
      set(header "${CMAKE_MATCH_1}")
      cmake_path(GET header PARENT_PATH other)
      string(REGEX MATCH "^[^/]*" layer "${other}")
      if(other STREQUAL "")
        complain("${source}: ${line}: write includes from the root of the repository")
      elseif(NOT other STREQUAL folder AND NOT other IN_LIST may_${folder}
             AND NOT layer IN_LIST may_${folder} AND NOT "${own}:${header}" IN_LIST exceptions)
        if("${may_${folder}}" STREQUAL "")
          complain("${source}: ${line}: ${folder} may include nothing but itself")
        else()
          string(REPLACE ";" ", " shown "${may_${folder}}")
          complain("${source}: ${line}: ${folder} may include ${shown} and itself only")
        endif()
      endif()
    elseif(line MATCHES "<([^>]+)>")
      set(header "${CMAKE_MATCH_1}")
      foreach(rule ${libraries})
        string(REGEX MATCH "^(.*):([^:]+)$" matched "${rule}")
        if(header MATCHES "^${CMAKE_MATCH_1}")
          string(REGEX MATCH "^(.*):([^:]+)$" matched "${rule}")
          set(owner "${CMAKE_MATCH_2}")
          if(NOT "${folder}/" MATCHES "^${owner}/")
            complain("${source}: ${line}: only ${owner} may include this library")
          endif()
        endif()
      endforeach()
    endif()
  endforeach()
endforeach()
if(violations GREATER 0)
  message(FATAL_ERROR "${violations} includes break the order of folders (docs/decisions/01-layers.md)")
endif()
