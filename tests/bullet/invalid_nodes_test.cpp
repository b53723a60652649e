// Cloth with a node or a link that is no number, or far too large: the rest of the cloth goes on, and the status tells.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
constexpr int kNode = 300, kLink = 300;

struct Harm
{
    const char* m_name;
    std::function<void(btSoftBody&)> m_apply;
    int m_most;  // number of nodes that may be lost
};

void moveNode(btSoftBody& cloth, float x)
{
    cloth.m_nodes[kNode].m_x.setX(x);
    cloth.m_nodes[kNode].m_q.setX(x);
}

const Harm kHarms[] = {{"velocity NaN", [](btSoftBody& cloth) { cloth.m_nodes[kNode].m_v.setX(kNoNumber); }, 1},
                       {"velocity 1e18", [](btSoftBody& cloth) { cloth.m_nodes[kNode].m_v.setX(1e18f); }, 1},
                       {"position 1e12", [](btSoftBody& cloth) { moveNode(cloth, 1e12f); }, 1},
                       {"force NaN", [](btSoftBody& cloth) { cloth.m_nodes[kNode].m_f.setX(kNoNumber); }, 1},
                       {"inverse mass 1e30", [](btSoftBody& cloth) { cloth.m_nodes[kNode].m_im = 1e30f; }, 1},
                       {"inverse mass infinite", [](btSoftBody& cloth) { cloth.m_nodes[kNode].m_im = kInfinity; }, 1},
                       {"rest length infinite", [](btSoftBody& cloth) { cloth.m_links[kLink].m_c1 = kInfinity; }, 0},
                       {"mass sum 1e-42", [](btSoftBody& cloth) { cloth.m_links[kLink].m_c0 = 1e-42f; }, 2}};

// Steps a cloth that hangs free or lies on a box. Expects few nodes to be lost, and a message in the first step with
// one.
void expectIsolated(SolverPlace place, bool hasBox, const Harm& harm)
{
    Plugin plugin(settingsFor(place));
    MeshShape box(makeBox(2, 0.2f, 2));
    DropWorld world(&plugin);
    if (hasBox) world.addObstacle(box.shape());
    ClothSpec spec;
    spec.m_nodes = 25;
    spec.m_centre = btVector3(0, btScalar(0.15), 0);
    btSoftBody& cloth = world.addCloth(spec);
    world.step(20);
    harm.m_apply(cloth);
    bool isTold = false;
    for (int step = 0; step < 6; ++step)
    {
        world.step();
        int lost = 0;
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
            lost += !(cloth.m_nodes[i].m_x.length() < 100);
        EXPECT_LE(lost, harm.m_most) << "step " << step;
        isTold = isTold || (plugin.statistics().m_status & kStepInvalidNodes) != 0;
        EXPECT_EQ(isTold, lost > 0) << "step " << step;
    }
    EXPECT_EQ(isTold, harm.m_most > 0);
}
}  // namespace

TEST(InvalidNodes, DoNotSpreadOverLinksAndAreReportedWithoutAPair)
{
    for (const SolverPlace place : {SolverPlace::Host, SolverPlace::Device})
    {
        for (const bool hasBox : {false, true})
        {
            for (const Harm& harm : kHarms)
            {
                SCOPED_TRACE(std::string(harm.m_name) + (hasBox ? ", box" : ", free") +
                             (place == SolverPlace::Host ? ", host" : ", device"));
                expectIsolated(place, hasBox, harm);
            }
        }
    }
}
}  // namespace drape::test
