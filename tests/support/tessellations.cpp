#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>

#include "tests/support/analytic_surfaces.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::shapes {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<std::int32_t, 3>;

/// The same numbers with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double signed_uniform() { return 2 * uniform() - 1; }
  double gaussian() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  std::size_t below(std::size_t n) { return engine_() % n; }

 private:
  std::mt19937_64 engine_;
};

/// Parameters in place of points, and how they are spaced.
struct DomainMesh {
  TriangleMesh mesh;
  Domain domain;
  Vector3d cell;  ///< parameters from one vertex to the next

  /// b - a, the short way round.
  Vector3d difference(const Vector3d& a, const Vector3d& b) const {
    Vector3d d = b - a;
    const bool s_wraps = domain == Domain::kTorus || domain == Domain::kCylinder;
    if (s_wraps) d.x() -= std::round(d.x());
    if (domain == Domain::kTorus) d.y() -= std::round(d.y());
    return d;
  }
};

DomainMesh spherical_domain(int vertices) {
  int levels = 0;
  while (20 * std::pow(4, levels) < vertices) ++levels;
  DomainMesh d{icosphere(levels), Domain::kSphere, {}};
  d.cell = Vector3d::Constant(mean_edge_length(d.mesh));
  return d;
}

/// `ns` x `nt` vertices; connectivity as the shapes of that topology have it.
DomainMesh grid_domain(Domain domain, int vertices) {
  // Cells of the torus and the cylinder are then about square.
  const double aspect = domain == Domain::kSquare ? 1 : 2.5;
  const int nt = std::max(3, static_cast<int>(std::lround(std::sqrt(vertices / aspect) / 2)) * 2);
  const int ns = domain == Domain::kSquare ? nt : std::max(3, vertices / nt / 2 * 2);
  const int last_s = domain == Domain::kSquare ? ns - 1 : ns;
  const int last_t = domain == Domain::kTorus ? nt : nt - 1;
  DomainMesh d{{}, domain, {1.0 / last_s, 1.0 / last_t, 0}};
  if (domain == Domain::kTorus) d.mesh = torus(1, 0.4, ns, nt);
  if (domain == Domain::kCylinder) d.mesh = cylinder(1, 1, ns, nt - 1);
  if (domain == Domain::kSquare) d.mesh = plane(1, nt - 1);
  for (int i = 0; i < ns; ++i)
    for (int j = 0; j < nt; ++j)
      d.mesh.points[i * nt + j] = {static_cast<double>(i) / last_s, static_cast<double>(j) / last_t,
                                   0};
  return d;
}

/// Leaves rims where they are, keeps periods, and has no fold.
void warp(DomainMesh& d) {
  constexpr double kAmount = 0.5;
  const double pi = std::numbers::pi;
  for (Vector3d& p : d.mesh.points) {
    if (d.domain == Domain::kSphere) {
      const Vector3d field(std::sin(3 * p.y()), std::sin(3 * p.z()), std::sin(3 * p.x()));
      p = (p + 0.22 * field).normalized();
      continue;
    }
    const auto moved = [&](double a, double b) {
      const double along = std::sin(4 * pi * a) / (4 * pi);
      const double shear = std::pow(std::sin(pi * a), 2) * std::sin(2 * pi * b) / 20;
      return a + kAmount * (along + shear);
    };
    p = Vector3d(moved(p.x(), p.y()), moved(p.y(), p.x()), 0);
  }
}

/// Along rims vertices move along them only.
void jitter(DomainMesh& d) {
  Random random(1);
  for (Vector3d& p : d.mesh.points) {
    Vector3d move;
    for (int c = 0; c < 3; ++c) move[c] = 0.3 * random.signed_uniform() * d.cell[c];
    if (d.domain == Domain::kSphere) {
      p = (p + move - move.dot(p) * p).normalized();
      continue;
    }
    if (d.domain == Domain::kSquare && (p.x() == 0 || p.x() == 1)) move.x() = 0;
    if (d.domain != Domain::kTorus && (p.y() == 0 || p.y() == 1)) move.y() = 0;
    p += move;
  }
}

std::vector<std::vector<std::int32_t>> neighbours_of(const TriangleMesh& mesh) {
  std::vector<std::vector<std::int32_t>> result(mesh.points.size());
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      result[t[i]].push_back(t[(i + 1) % 3]);
      result[t[(i + 1) % 3]].push_back(t[i]);
    }
  for (auto& list : result) {
    std::ranges::sort(list);
    const auto rest = std::ranges::unique(list);
    list.erase(rest.begin(), rest.end());
  }
  return result;
}

/// v and all within `reach` edges of it.
std::set<std::int32_t> rings(const std::vector<std::vector<std::int32_t>>& neighbours,
                             std::int32_t v, int reach) {
  std::set<std::int32_t> found{v}, front{v};
  for (int ring = 0; ring < reach; ++ring) {
    std::set<std::int32_t> grown;
    for (const std::int32_t a : front)
      for (const std::int32_t b : neighbours[a])
        if (found.insert(b).second) grown.insert(b);
    front = std::move(grown);
  }
  return found;
}

/// Splits the edges across from `hub` until it has `valence` neighbours.
class HubMaker {
 public:
  explicit HubMaker(DomainMesh& d) : d_(d) {
    for (std::size_t f = 0; f < d.mesh.triangles.size(); ++f) enter(static_cast<std::int32_t>(f));
    for (std::size_t f = 0; f < d.mesh.triangles.size(); ++f) first_face(f);
  }

  void make(std::int32_t hub, int valence) {
    std::vector<std::pair<std::int32_t, std::int32_t>> link;
    std::int32_t a = start_[hub];
    do {
      const std::int32_t b = apex({hub, a});
      link.emplace_back(a, b);
      a = b;
    } while (a != start_[hub]);
    const int count = static_cast<int>(link.size());
    for (int i = 0; i < count; ++i) {
      const int extra = valence - count;
      split(hub, link[i], extra * (i + 1) / count - extra * i / count);
    }
  }

 private:
  using Edge = std::pair<std::int32_t, std::int32_t>;

  void enter(std::int32_t f) {
    const Triangle& t = d_.mesh.triangles[f];
    for (int i = 0; i < 3; ++i) face_[{t[i], t[(i + 1) % 3]}] = f;
  }
  void first_face(std::size_t f) {
    start_.resize(d_.mesh.points.size());
    const Triangle& t = d_.mesh.triangles[f];
    for (int i = 0; i < 3; ++i) start_[t[i]] = t[(i + 1) % 3];
  }
  /// The third corner of the face left of an edge.
  std::int32_t apex(const Edge& e) const {
    const Triangle& t = d_.mesh.triangles[face_.at(e)];
    for (int i = 0; i < 3; ++i)
      if (t[i] != e.first && t[i] != e.second) return t[i];
    return -1;
  }
  /// Face (hub, p, q) and its neighbour (q, p, o) become extra + 1 faces each.
  void split(std::int32_t hub, const Edge& e, int extra) {
    const auto [p, q] = e;
    const std::int32_t o = apex({q, p});
    const std::int32_t inner = face_.at({p, q}), outer = face_.at({q, p});
    const Vector3d from = d_.mesh.points[p];
    const Vector3d whole = d_.difference(from, d_.mesh.points[q]);
    std::int32_t last = p;
    for (int i = 1; i <= extra + 1; ++i) {
      std::int32_t next = q;
      if (i <= extra) {
        next = static_cast<std::int32_t>(d_.mesh.points.size());
        d_.mesh.points.push_back(from + whole * i / (extra + 1));
      }
      place(i == 1 ? inner : -1, {hub, last, next});
      place(i == 1 ? outer : -1, {next, last, o});
      last = next;
    }
  }
  void place(std::int32_t f, const Triangle& t) {
    if (f < 0) {
      f = static_cast<std::int32_t>(d_.mesh.triangles.size());
      d_.mesh.triangles.push_back(t);
    } else {
      d_.mesh.triangles[f] = t;
    }
    enter(f);
  }

  DomainMesh& d_;
  std::map<Edge, std::int32_t> face_;  ///< left of a directed edge
  std::vector<std::int32_t> start_;    ///< a neighbour of every vertex
};

/// Whether the faces round v that do not touch its neighbour a keep a fair share of their area when
/// v moves onto a: else a face as flat as a needle would end up standing on its edge.
bool can_move_onto(const DomainMesh& d, const std::vector<std::int32_t>& faces, std::int32_t v,
                   std::int32_t a) {
  const auto& points = d.mesh.points;
  return std::ranges::all_of(faces, [&](std::int32_t f) {
    const Triangle& t = d.mesh.triangles[f];
    if (std::ranges::count(t, a) > 0) return true;
    const auto corner = std::ranges::find(t, v) - t.begin();
    const std::int32_t p = t[(corner + 1) % 3], q = t[(corner + 2) % 3];
    const auto area = [&](std::int32_t from) {
      const Vector3d to_p = d.difference(points[from], points[p]);
      const Vector3d to_q = d.difference(points[from], points[q]);
      return to_p.cross(to_q).eval();
    };
    return area(a).dot(area(v)) > 0.2 * area(v).squaredNorm();
  });
}

/// One vertex in 60 moves to a 50th of an edge from a neighbour, one in 400 gets 30 neighbours;
/// none of them near another, or near a rim.
void add_needles(DomainMesh& d) {
  constexpr double kShort = 1.0 / 50;
  constexpr int kValence = 30;
  const auto neighbours = neighbours_of(d.mesh);
  const std::size_t n = d.mesh.points.size();
  std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
  std::vector<std::vector<std::int32_t>> faces(n);
  for (std::size_t f = 0; f < d.mesh.triangles.size(); ++f)
    for (int i = 0; i < 3; ++i) {
      const Triangle& t = d.mesh.triangles[f];
      ++uses[std::minmax(t[i], t[(i + 1) % 3])];
      faces[t[i]].push_back(static_cast<std::int32_t>(f));
    }
  std::vector<bool> taken(n);
  for (const auto& [edge, count] : uses)
    if (count == 1)
      for (const std::int32_t v : rings(neighbours, edge.first, 3)) taken[v] = true;

  Random random(2);
  std::vector<std::int32_t> hubs, needles;
  const auto choose = [&](std::size_t count, std::vector<std::int32_t>& chosen) {
    for (std::size_t tries = 0; tries < 20 * n && chosen.size() < count; ++tries) {
      const auto v = static_cast<std::int32_t>(random.below(n));
      const auto around = rings(neighbours, v, 2);
      if (std::ranges::any_of(around, [&](std::int32_t a) { return taken[a]; })) continue;
      for (const std::int32_t a : around) taken[a] = true;
      chosen.push_back(v);
    }
  };
  choose(std::max<std::size_t>(1, n / 400), hubs);
  choose(std::max<std::size_t>(1, n / 60), needles);

  for (const std::int32_t v : needles) {
    std::vector<std::int32_t> targets = neighbours[v];
    std::erase_if(targets, [&](std::int32_t a) { return !can_move_onto(d, faces[v], v, a); });
    if (targets.empty()) continue;
    const Vector3d base = d.mesh.points[targets[random.below(targets.size())]];
    d.mesh.points[v] = base + kShort * d.difference(base, d.mesh.points[v]);
  }
  HubMaker maker(d);
  for (const std::int32_t v : hubs) maker.make(v, kValence);
}

}  // namespace

const char* name_of(Tessellation tessellation) {
  switch (tessellation) {
    case Tessellation::kEven:
      return "even";
    case Tessellation::kUneven:
      return "uneven";
    case Tessellation::kRagged:
      return "ragged";
    case Tessellation::kNeedles:
      break;
  }
  return "needles";
}

AnalyticMesh tessellate(const AnalyticSurface& surface, Tessellation tessellation, int vertices) {
  DomainMesh d = surface.domain == Domain::kSphere ? spherical_domain(vertices)
                                                   : grid_domain(surface.domain, vertices);
  if (tessellation == Tessellation::kUneven) warp(d);
  if (tessellation == Tessellation::kRagged) jitter(d);
  if (tessellation == Tessellation::kNeedles) add_needles(d);
  AnalyticMesh result{std::move(d.mesh), {}};
  for (Vector3d& p : result.mesh.points) {
    result.truth.push_back(surface.at(p));
    p = result.truth.back().position;
  }
  return result;
}

double mean_edge_length(const TriangleMesh& mesh) {
  const auto neighbours = neighbours_of(mesh);
  double sum = 0, edges = 0;
  for (std::size_t v = 0; v < neighbours.size(); ++v)
    for (const std::int32_t w : neighbours[v]) {
      sum += (mesh.points[v] - mesh.points[w]).norm();
      edges += 1;
    }
  return edges > 0 ? sum / edges : 0;
}

void add_normal_noise(AnalyticMesh& mesh, double sigma, std::uint64_t seed) {
  Random random(seed);
  for (std::size_t v = 0; v < mesh.truth.size(); ++v)
    mesh.mesh.points[v] += sigma * random.gaussian() * mesh.truth[v].normal;
}

}  // namespace semigeo::shapes
