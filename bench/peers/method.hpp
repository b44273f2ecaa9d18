#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "kernels/surface/surface.hpp"
#include "tests/support/analytic_surfaces.hpp"

namespace semigeo::peers {

/// A mesh on which methods are measured.
struct Subject {
  std::string name;
  kernels::Surface surface;                 ///< Built and ordered as a surface job does it.
  std::vector<Eigen::Vector3d> normals;     ///< (N) Unit normals, weighted by area.
  std::vector<shapes::SurfacePoint> truth;  ///< (N) True curvature, or empty.
};

/// Makes a subject of a mesh. `truth` belongs to the vertices of the mesh, or is empty. Throws
/// std::logic_error if there is a truth and the mesh needs repairs.
Subject make_subject(std::string name, kernels::TriangleMesh mesh,
                     std::vector<shapes::SurfacePoint> truth = {});

/// Holds what a method found in one run over a subject.
struct Result {
  double seconds = 0;  ///< CPU time of what is timed.
  double items = 0;    ///< What the time is divided by: vertices or pairs of points; 0: not run.
  std::vector<double> gaussian;  ///< (N) K, NaN if there is none; empty if the method has none.
  std::vector<double> mean;      ///< (N) H, negative where convex; empty if the method has none.
};

/// A way to describe a surface at every vertex.
struct Method {
  std::string name;
  std::function<Result(const Subject&)> run;
};

/// Says what one library adds.
struct Library {
  std::string name;
  std::string package;          ///< Package of Debian that has it.
  std::string version;          ///< Empty if the library is not installed.
  std::vector<Method> methods;  ///< Empty if the library is not installed.
};

/// Returns the CPU time of this process, in seconds.
double cpu_seconds();

Library ours();
Library cgal();
Library point_cloud_library();
Library opencv();

}  // namespace semigeo::peers
