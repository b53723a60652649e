// FCL as a peer: BVHModel<KDOP<float, 18>>, refitted bottom-up, collided by its recursion.
#include <cmath>
#include <limits>

#include "benchmarks/support/fcl_model.h"

#include <fcl/narrowphase/detail/traversal/collision/mesh_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/traversal_recurse.h>

#include "benchmarks/support/peer_scene.h"
#include "benchmarks/bench_step/peer_methods.h"
#include "benchmarks/support/samples.h"

namespace drape::bench
{
namespace
{
void build(FclModel& model, const std::vector<Triangle>& triangles, const float* positions, std::size_t vertices)
{
    buildFclModel(
        model, triangles.size(), [&](std::size_t t) { return triangles[t].m_vertices; }, positions, vertices);
}

// Grows every volume of a tree: the same as growing the triangles first.
void grow(FclModel& model, float reach)
{
    for (int i = 0; i < model.getNumBVs(); ++i)
    {
        FclVolume& volume = model.getBV(i).bv;
        for (std::size_t d = 0; d < 9; ++d)
        {
            const float by = d < 3 ? reach : reach * 1.4142137f;  // √2 rounded up: the diagonal directions' length
            volume.dist(d) -= by;
            volume.dist(d + 9) += by;
        }
    }
}

// Takes the pairs whose volumes overlap instead of testing the triangles.
class PairNode : public fcl::detail::MeshCollisionTraversalNode<FclVolume>
{
public:
    void leafTesting(int a, int b) const override
    {
        m_pairs.push_back(Candidate{static_cast<std::uint32_t>(this->model1->getBV(a).primitiveId()),
                                    static_cast<std::uint32_t>(this->model2->getBV(b).primitiveId())});
    }
    bool canStop() const override { return false; }

    mutable std::vector<Candidate> m_pairs;
};

class FclMethod : public StepMethod
{
public:
    FclMethod(const StepScene& scene, bool grown) : m_grown(grown), m_reach(contactReach(scene))
    {
        const PeerScene peer(scene);
        m_nodes = peer.clothNodes();
        const Clock::time_point start = Clock::now();
        build(m_obstacle, peer.obstacleTriangles(), peer.obstaclePositions().data(),
              peer.obstaclePositions().size() / 3);
        m_buildMs = millisecondsSince(start);
        build(m_cloth, peer.clothTriangles(), scene.start(0), m_nodes);
    }

    StepOutcome step(const float*, const float* end) override
    {
        StepOutcome outcome;
        const Clock::time_point begin = Clock::now();
        if (m_grown)
        {
            // The update keeps the nodes of the step before, which is the start of this one. The volumes then hold the
            // motion.
            m_cloth.beginUpdateModel();
            m_cloth.updateSubModel(fclVectors(end, m_nodes));
            m_cloth.endUpdateModel(true, true);
            grow(m_cloth, m_reach);
        }
        else
        {
            refitFclModel(m_cloth, end, m_nodes);
        }
        const double refitMs = millisecondsSince(begin);
        m_grown ? collectPairs(outcome) : intersect(outcome);
        const double stepMs = millisecondsSince(begin);
        outcome.m_stages = {{"step", stepMs}, {"refit", refitMs}, {"broad", stepMs - refitMs}};
        return outcome;
    }

    void describe(Row& row) const override
    {
        row["backend"] = "fcl";
        row["device"] = "host";
        row["driver"] = "FCL " FCL_VERSION;
        row["threads"] = 1;
        row["prepare_ms"] = m_buildMs;
    }

private:
    void intersect(StepOutcome& outcome)
    {
        fcl::CollisionRequest<float> request;
        request.num_max_contacts = std::numeric_limits<std::size_t>::max();
        fcl::CollisionResult<float> result;
        fcl::detail::MeshCollisionTraversalNode<FclVolume> node;
        traverse(node, request, result);
        outcome.m_candidates = static_cast<std::size_t>(node.num_leaf_tests);
        outcome.m_contacts = result.numContacts();
    }

    void collectPairs(StepOutcome& outcome)
    {
        fcl::CollisionResult<float> result;
        PairNode node;
        traverse(node, fcl::CollisionRequest<float>(), result);
        outcome.m_candidates = node.m_pairs.size();
    }

    void traverse(fcl::detail::MeshCollisionTraversalNode<FclVolume>& node, const fcl::CollisionRequest<float>& request,
                  fcl::CollisionResult<float>& result)
    {
        fcl::Transform3<float> still = fcl::Transform3<float>::Identity(), stillToo = still;
        fcl::detail::initialize(node, m_cloth, still, m_obstacle, stillToo, request, result, true, true);
        node.enable_statistics = true;
        node.num_leaf_tests = 0;
        fcl::detail::collisionRecurse<float>(&node, 0, 0, nullptr);
    }

    bool m_grown;
    float m_reach;
    std::size_t m_nodes = 0;
    FclModel m_cloth, m_obstacle;
    double m_buildMs = 0;
};
}  // namespace

std::unique_ptr<StepMethod> makeFclMethod(const StepScene& scene, bool grown, std::string&)
{
    return std::make_unique<FclMethod>(scene, grown);
}
}  // namespace drape::bench
