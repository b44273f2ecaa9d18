#include "jobs/stages/match_triplets.hpp"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <span>
#include <utility>

#include "jobs/stages/for_each_on.hpp"

namespace semigeo::jobs {
namespace {

using kernels::Posting;
using kernels::Triplet;

/// The number of postings that stay in the first-level cache while all lookups of a cell pass.
constexpr std::int64_t kTile = 512;
/// The number of groups of blocks whose matches are gathered side by side.
constexpr std::size_t kGroups = 32;

/// Returns the number of the triangle of each triplet. Triplets that differ only in the order of
/// their corners have the same number.
std::vector<std::uint32_t> triangles_of(const std::vector<Triplet>& triplets) {
  struct Place {
    std::uint64_t corners;
    std::uint32_t triplet;
  };
  std::vector<Place> sorted;
  sorted.reserve(triplets.size());
  for (const Triplet& triplet : triplets) {
    std::array<std::uint16_t, 3> corners = triplet.corners;
    std::ranges::sort(corners);
    std::uint64_t packed = 0;
    for (const std::uint16_t corner : corners) packed = packed << 16 | corner;
    sorted.push_back({packed, static_cast<std::uint32_t>(sorted.size())});
  }
  std::ranges::sort(sorted, {}, &Place::corners);
  std::vector<std::uint32_t> numbers(triplets.size());
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (i > 0 && sorted[i].corners != sorted[i - 1].corners) ++number;
    numbers[sorted[i].triplet] = number;
  }
  return numbers;
}

/// Returns a number in [0, 1). Numbers of different triangles are evenly spread (Weyl's sequence,
/// golden ratio).
double lot_of(std::uint32_t triangle) {
  return static_cast<double>(triangle * 2654435769U) / 4294967296.0;
}

/// The lookups of one cell in one block of postings.
struct Segment {
  std::int64_t block;
  std::int64_t first_posting;  ///< Index in the block.
  std::int64_t last_posting;
  std::size_t first_lookup;
  std::size_t last_lookup;
};

class Matcher {
 public:
  Matcher(const io::HashLibrary& library, const std::vector<Triplet>& scene,
          const LookUpTuning& tuning)
      : library_(library),
        cells_(library.cells()),
        scene_(scene),
        triangles_(triangles_of(scene)),
        tuning_(tuning) {}

  TripletMatches run(const engine::RunContext& context) {
    const double triangles = triangles_.empty() ? 1 : 1.0 + std::ranges::max(triangles_);
    double share = std::min(1.0, static_cast<double>(tuning_.most_triangles) / triangles);
    look_up(share);
    if (const auto compared = static_cast<double>(comparisons());
        compared > tuning_.many_compared) {
      const double matches = compared * match_rate(context);
      const double most =
          std::min(static_cast<double>(tuning_.most_compared) / compared,
                   static_cast<double>(tuning_.most_matches) / std::max(matches, 1.0));
      if (most < 1) look_up(share *= most);
    }
    cut_into_blocks();
    std::vector<std::vector<TripletMatch>> found(blocks_.size());
    context.workers.for_blocks(static_cast<std::int64_t>(blocks_.size()), 1,
                               [&](engine::IndexRange range) {
                                 for (auto i = range.begin; i < range.end; ++i)
                                   compare_block(blocks_[i], found[i]);
                               });
    return gathered(found, context);
  }

 private:
  /// Sorts triplets of an even share of the triangles by the cells that they look into. Those of
  /// cell c begin at lookups_[first_lookup_[c]].
  void look_up(double share) {
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t i = 0; i < scene_.size(); ++i)
      if (share >= 1 || lot_of(triangles_[i]) < share) chosen.push_back(i);
    first_lookup_.assign(cells_.size(), 0);
    const auto for_each_lookup = [&](const auto& body) {
      std::uint32_t last_cell = 0;
      std::vector<std::uint32_t> cells;
      for (const std::uint32_t i : chosen) {
        if (cells.empty() || scene_[i].cell != last_cell) {
          last_cell = scene_[i].cell;
          cells = kernels::cells_around(last_cell);
          std::erase_if(cells, [&](std::uint32_t c) { return cells_[c] == cells_[c + 1]; });
        }
        for (const std::uint32_t cell : cells) body(cell, i);
      }
    };
    for_each_lookup([&](std::uint32_t cell, std::uint32_t) { ++first_lookup_[cell + 1]; });
    std::partial_sum(first_lookup_.begin(), first_lookup_.end(), first_lookup_.begin());
    lookups_.resize(first_lookup_.back());
    std::vector<std::size_t> next = first_lookup_;
    for_each_lookup(
        [&](std::uint32_t cell, std::uint32_t triplet) { lookups_[next[cell]++] = triplet; });
  }

  std::int64_t comparisons() const {
    std::int64_t sum = 0;
    for (std::size_t cell = 0; cell + 1 < cells_.size(); ++cell)
      sum += static_cast<std::int64_t>((first_lookup_[cell + 1] - first_lookup_[cell]) *
                                       (cells_[cell + 1] - cells_[cell]));
    return sum;
  }

  /// Returns the number of matches for each comparison, in a few blocks that are spread evenly.
  double match_rate(const engine::RunContext& context) {
    cut_into_blocks();
    const std::size_t step = std::max<std::size_t>(blocks_.size() / tuning_.probed_blocks, 1);
    const std::size_t probed = (blocks_.size() + step - 1) / step;
    std::vector<std::int64_t> compared(probed);
    std::vector<std::int64_t> matches(probed);
    context.workers.for_blocks(static_cast<std::int64_t>(probed), 1, [&](engine::IndexRange range) {
      for (auto i = range.begin; i < range.end; ++i) {
        const auto [first, last] = blocks_[static_cast<std::size_t>(i) * step];
        std::vector<TripletMatch> found;
        compare_block({first, std::min(last, first + tuning_.probed_segments)}, found);
        matches[i] = static_cast<std::int64_t>(found.size());
        for (std::size_t s = first; s < std::min(last, first + tuning_.probed_segments); ++s)
          compared[i] +=
              (segments_[s].last_posting - segments_[s].first_posting) *
              static_cast<std::int64_t>(segments_[s].last_lookup - segments_[s].first_lookup);
      }
    });
    const auto sum = [](const std::vector<std::int64_t>& values) {
      return static_cast<double>(std::accumulate(values.begin(), values.end(), std::int64_t{0}));
    };
    return sum(matches) / std::max(sum(compared), 1.0);
  }

  void cut_into_blocks() {
    blocks_.clear();
    segments_.clear();
    const std::int64_t size = library_.block_size();
    for (std::size_t cell = 0; cell + 1 < cells_.size(); ++cell) {
      const std::size_t first = first_lookup_[cell];
      const std::size_t last = first_lookup_[cell + 1];
      if (first == last) continue;
      const auto end = static_cast<std::int64_t>(cells_[cell + 1]);
      for (auto at = static_cast<std::int64_t>(cells_[cell]); at < end;) {
        const std::int64_t block = at / size;
        const std::int64_t until = std::min(end, (block + 1) * size);
        if (blocks_.empty() || segments_[blocks_.back().first].block != block)
          blocks_.emplace_back(segments_.size(), segments_.size());
        segments_.push_back({block, at - block * size, until - block * size, first, last});
        blocks_.back().second = segments_.size();
        at = until;
      }
    }
  }

  void compare_block(const std::pair<std::size_t, std::size_t>& segments,
                     std::vector<TripletMatch>& found) const {
    const std::vector<Posting> postings = library_.read_block(segments_[segments.first].block);
    std::vector<std::uint32_t> compatible;
    for (std::size_t s = segments.first; s < segments.second; ++s) {
      const Segment& segment = segments_[s];
      for (std::int64_t tile = segment.first_posting; tile < segment.last_posting; tile += kTile) {
        const std::int64_t end = std::min(segment.last_posting, tile + kTile);
        const auto some = std::span(postings).subspan(tile, end - tile);
        for (std::size_t l = segment.first_lookup; l < segment.last_lookup; ++l)
          compare(lookups_[l], some, compatible, found);
      }
    }
  }

  void compare(std::uint32_t index, std::span<const Posting> postings,
               std::vector<std::uint32_t>& compatible, std::vector<TripletMatch>& found) const {
    const Triplet& triplet = scene_[index];
    compatible.clear();
    kernels::find_compatible(triplet.invariants, postings, compatible);
    for (const std::uint32_t i : compatible)
      found.push_back({.triangle = triangles_[index],
                       .model = postings[i].model,
                       .scene_corners = triplet.corners,
                       .model_corners = postings[i].corners});
  }

  /// Sorts the matches of all blocks by model. Matches of one model keep the order of the blocks.
  TripletMatches gathered(const std::vector<std::vector<TripletMatch>>& found,
                          const engine::RunContext& context) const {
    TripletMatches result;
    result.scene_triplets = static_cast<std::int64_t>(scene_.size());
    result.compared = comparisons();
    const std::size_t models = library_.models().size();
    const std::size_t groups = std::min(kGroups, found.size());
    const auto for_each = for_each_on(context.workers);
    const auto for_each_match = [&](std::int64_t index, const auto& body) {
      const auto group = static_cast<std::size_t>(index);
      const std::size_t end = (group + 1) * found.size() / groups;
      for (std::size_t block = group * found.size() / groups; block < end; ++block)
        for (const TripletMatch& match : found[block]) body(match);
    };
    // Where the next match of each model in each group belongs; at first how many there are.
    std::vector<std::vector<std::int64_t>> next(groups, std::vector<std::int64_t>(models));
    std::vector<std::uint32_t> of_triangle(scene_.size());  // there are at most as many triangles
    for_each(std::ssize(next), [&](std::int64_t group) {
      for_each_match(group, [&](const TripletMatch& match) {
        ++next[group][match.model];
        std::atomic_ref(of_triangle[match.triangle]).fetch_add(1, std::memory_order_relaxed);
      });
    });
    std::int64_t first = 0;
    for (std::size_t model = 0; model < models; ++model) {
      result.first.push_back(first);
      for (std::vector<std::int64_t>& of_group : next)
        first += std::exchange(of_group[model], first);
    }
    result.first.push_back(first);
    result.matches.resize(first);
    for_each(std::ssize(next), [&](std::int64_t group) {
      for_each_match(group, [&](const TripletMatch& match) {
        TripletMatch& placed = result.matches[next[group][match.model]++];
        placed = match;
        placed.weight = 1.0F / static_cast<float>(of_triangle[match.triangle]);
      });
    });
    result.votes.assign(models, 0);
    for_each(std::ssize(result.votes), [&](std::int64_t model) {
      for (auto i = result.first[model]; i < result.first[model + 1]; ++i)
        result.votes[model] += result.matches[i].weight;
    });
    return result;
  }

  const io::HashLibrary& library_;
  std::span<const std::uint64_t> cells_;
  const std::vector<Triplet>& scene_;
  std::vector<std::uint32_t> triangles_;  ///< Number of the triangle of each triplet.
  const LookUpTuning& tuning_;
  std::vector<std::size_t> first_lookup_;  ///< (cells + 1)
  std::vector<std::uint32_t> lookups_;     ///< Indices of triplets of the scene.
  std::vector<Segment> segments_;
  std::vector<std::pair<std::size_t, std::size_t>> blocks_;  ///< Ranges of segments.
};

}  // namespace

TripletMatches match_triplets(const io::HashLibrary& library, const std::vector<Triplet>& scene,
                              const LookUpTuning& tuning, const engine::RunContext& context) {
  return Matcher(library, scene, tuning).run(context);
}

}  // namespace semigeo::jobs
