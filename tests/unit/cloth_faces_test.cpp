// Finds the faces of each node, compared with a search of all faces.
#include "bullet_plugin/core/solver/topology/cloth_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "scenes/random.h"

namespace drape::test
{
namespace
{
using Face = std::array<std::int32_t, 3>;

std::vector<Face> facesOf(const ClothFaces& faces, std::size_t node)
{
    std::vector<Face> found;
    faces.forFacesOf(node, [&](const std::int32_t* face) { found.push_back({face[0], face[1], face[2]}); });
    return found;
}

// Returns the faces whose nodes all exist, once for each corner that is the node.
std::vector<Face> lookedUp(const std::vector<std::int32_t>& triangles, std::int32_t nodeCount, std::int32_t node)
{
    std::vector<Face> found;
    for (std::size_t i = 0; i < triangles.size(); i += 3)
    {
        const Face face = {triangles[i], triangles[i + 1], triangles[i + 2]};
        for (const std::int32_t own : face)
            if (own == node && *std::min_element(face.begin(), face.end()) >= 0 &&
                *std::max_element(face.begin(), face.end()) < nodeCount)
                found.push_back(face);
    }
    return found;
}
}  // namespace

TEST(ClothFaces, FacesOfANodeAreTheFacesThatContainIt)
{
    Random random(17);
    SCOPED_TRACE("seed 17");
    for (const std::int32_t nodeCount : {1, 2, 7, 200})
    {
        std::vector<std::int32_t> triangles;
        for (int i = 0; i < 3 * 300; ++i)  // some name nodes that are not there, some one twice
            triangles.push_back(static_cast<std::int32_t>(random.within(-1.9, nodeCount + 1)));
        const ClothFaces faces(triangles, std::size_t(nodeCount));
        EXPECT_EQ(faces.triangles(), triangles);
        ASSERT_EQ(faces.nodeCount(), std::size_t(nodeCount));
        std::size_t all = 0;
        for (std::int32_t node = 0; node < nodeCount; ++node)
        {
            const std::vector<Face> expected = lookedUp(triangles, nodeCount, node);
            EXPECT_EQ(facesOf(faces, std::size_t(node)), expected) << "node " << node << " of " << nodeCount;
            all += expected.size();
        }
        EXPECT_GT(all, 0u);
    }
}

TEST(ClothFaces, AClothMayHaveNoFaces)
{
    EXPECT_EQ(ClothFaces().nodeCount(), 0u);
    const ClothFaces faces({}, 2);
    EXPECT_EQ(faces.nodeCount(), 2u);
    EXPECT_TRUE(facesOf(faces, 1).empty());
}
}  // namespace drape::test
