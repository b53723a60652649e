// FCL's hierarchy of float 18-DOPs over a mesh, as both programs build and refit it.
#pragma once

#include <fcl/math/bv/utility.h>
#include <fcl/geometry/bvh/BVH_model.h>

#include <vector>

namespace drape::bench
{
using FclVolume = fcl::KDOP<float, 18>;
using FclModel = fcl::BVHModel<FclVolume>;

inline std::vector<fcl::Vector3<float>> fclVectors(const float* positions, std::size_t count)
{
    std::vector<fcl::Vector3<float>> vectors(count);
    for (std::size_t i = 0; i < count; ++i)
        vectors[i] = fcl::Vector3<float>(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    return vectors;
}

// corners(t) gives three vertex numbers of triangle t.
template <typename Corners>
void buildFclModel(FclModel& model, std::size_t triangles, Corners corners, const float* positions,
                   std::size_t vertices)
{
    std::vector<fcl::Triangle> indices;
    for (std::size_t t = 0; t < triangles; ++t)
    {
        const auto* corner = corners(t);
        indices.emplace_back(static_cast<std::size_t>(corner[0]), static_cast<std::size_t>(corner[1]),
                             static_cast<std::size_t>(corner[2]));
    }
    model.beginModel(static_cast<int>(triangles), static_cast<int>(vertices));
    model.addSubModel(fclVectors(positions, vertices), indices);
    model.endModel();
}

// Refits the model to new positions of the same vertices, bottom-up.
inline void refitFclModel(FclModel& model, const float* positions, std::size_t vertices)
{
    model.beginReplaceModel();
    model.replaceSubModel(fclVectors(positions, vertices));
    model.endReplaceModel(true, true);
}
}  // namespace drape::bench
