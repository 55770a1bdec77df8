// Matrix row-column sampling [Hasan07; Hasan09 section 3.3]: many lights become few.
//
// The lights' columns of the transport matrix are computed at a sample of rows (mrcs_rows.h,
// mrcs_columns.h), lights whose columns point the same way are clustered (mrcs_clusters.h), and one
// light of each cluster, drawn with probability p nearly in proportion to its weight and scaled by
// 1 / p, stands for all. Given any clustering, the mean over the draws is the light of all lights
// at every receiver, whether the rows see it or not.
//
// Deviations: one scale for the three channels (the paper's scale per channel is biased; it can be
// asked for); lights of weight 0 are not dropped; an even share of probability bounds the scale;
// columns are kept as sketches; errors are predicted from rows of their own; what is near a
// spherical light may be left out of its column, to be gathered from all lights (near_field.h). Each file's head says
// more.
#pragma once

#include "lobelia/gather/mrcs_clusters.h"
#include "lobelia/gather/mrcs_rows.h"

namespace lobelia {

struct MrcsSettings {
  GatherSettings gather;
  size_t columns = 5000;  // clusters; at most so many when there is an error limit
  double errorLimit = 0;  // relative error of the picture that these lights make; 0: none
  // Numbers kept of each column; 0: all (the paper's way). Chosen: all where they are few, else 64.
  static constexpr int kChosen = -1;
  int sketch = kChosen;
  uint64_t memory = uint64_t{2} << 30;  // bytes that the columns may take
  // Sum of lengths of the cluster over the light's length, channel by channel: less noise in
  // colours, biased.
  bool scalePerChannel = false;
  uint64_t seed = 0;
};

struct MrcsReport {
  uint64_t lights = 0, columns = 0, rows = 0, checkRows = 0;
  uint64_t sketch = 0;  // numbers kept of each column; 0: all, or none as all lights stay
  // Predicted relative error, sqrt(mean of squared error) / |light that is reduced, near fields
  // apart|: in the check rows, and in
  // the rows that the clusters were made for.
  double error = 0, rowError = 0;
};

// Few lights that stand for all, of the same classes, depths and groups. All of them when there are
// no more lights than columns and no error limit. Throws UsageError when the columns do not fit into the memory. When
// cancelled, what it returns is of no use.
VirtualLights reduceLights(const Tracer& tracer, const gather::Rows& rows,
                           const VirtualLights& lights, const MrcsSettings& settings,
                           MrcsReport* report, Context& context);

namespace gather {
// One light of each cluster, by its number, and the scale of its intensity; sorted by number.
struct Representative {
  uint32_t light = 0;
  Rgb scale = Rgb(1.f);
};
std::vector<Representative> drawRepresentatives(const LightColumns& columns,
                                                const Clustering& clustering, uint64_t seed);
}  // namespace gather

}  // namespace lobelia
