#include "reference/self_pairs.h"

#include "bullet_plugin/core/queries/refit.h"
#include "bullet_plugin/core/ordering/canonical_order.h"
#include "bullet_plugin/core/queries/self_collision.h"
#include "reference/pair_contacts.h"

namespace drape
{
namespace
{
// Returns whether a candidate is a contact.
bool decide(SelfView& view, const FeatureTest& test, std::uint32_t firstSlot, Contact* contact, SelfCounts& counts)
{
    std::uint32_t searches = 0;
    view.m_cloth.m_searches = &searches;
    const int found = selfContact(&view, test, firstSlot, contact);
    counts.m_swept += searches;
    return found == DRAPE_IS_CONTACT;
}

std::uint64_t invalidNodes(const SelfStep& step)
{
    std::uint64_t invalid = 0;
    for (const Triangle& triangle : step.m_cloths.triangles())
    {
        if (step.m_obstacleRadius[triangle.m_mesh] >= 0.0f || step.m_reach.m_radius[triangle.m_mesh] < 0.0f) continue;
        Dop ignored;
        invalid += leafVolume(&ignored, &triangle, step.start(), step.m_view.m_cloth.m_end, 0.0f);
    }
    return invalid;
}
}  // namespace

void selfVolumes(const SelfStep& step, std::vector<Dop>& volumes)
{
    const MeshPool& cloths = step.m_cloths;
    const ClothView& cloth = step.m_view.m_cloth;
    volumes.resize(cloths.vertexCount());
    for (std::size_t slot = 0; slot < cloths.meshCount(); ++slot)
    {
        const float radius = step.m_reach.m_radius[slot];
        const std::uint32_t first = cloths.mesh(slot).m_firstVertex;
        if (radius < 0.0f) continue;  // nobody asks
        for (std::uint32_t i = first; i < first + cloths.mesh(slot).m_topology.m_vertexCount; ++i)
            vertexVolume(&volumes[i], step.start(), cloth.m_end, i, radius);
    }
}

SelfFinder::SelfFinder(const SelfStep& step, const std::vector<Dop>& volumes, SelfStepLimits limits)
    : m_step(step),
      m_view(step.m_view),
      m_volumes(volumes),
      m_limits(limits),
      m_firstSlot(featureCountOf(step.m_view.m_cloth.m_nodeCount, step.m_view.m_cloth.m_triangleCount,
                                 std::uint32_t(step.m_cloths.edges().size())))
{
}

void SelfFinder::visit(const Candidate& pair)
{
    const Triangle* triangles = m_step.m_cloths.triangles().data();
    const std::uint32_t mesh = triangles[pair.m_cloth].m_mesh;
    if (mesh != triangles[pair.m_obstacle].m_mesh) return;
    FeaturePairs features;
    collectFeaturePairs(&features, triangles, pair, m_volumes.data());
    const float thickness = m_step.m_reach.m_thickness[mesh];
    for (std::uint32_t i = 0; i < features.m_vertexFaceCount; ++i)
        test({features.m_vertexFace[i].m_a, features.m_vertexFace[i].m_b, thickness, DRAPE_SELF_TEST_NODE});
    for (std::uint32_t i = 0; i < features.m_edgesCount; ++i)
        test({features.m_edges[i].m_a, features.m_edges[i].m_b, thickness, DRAPE_SELF_TEST_EDGE});
}

void SelfFinder::test(const FeatureTest& test)
{
    Contact contact;
    if (++m_counts.m_candidates > m_limits.m_candidates) return;
    if (decide(m_view, test, m_firstSlot, &contact, m_counts) && ++m_counts.m_contacts <= m_limits.m_contacts)
        m_found.push_back(contact);
}

void SelfFinder::append(std::vector<Contact>& contacts)
{
    if (!withinLimits() || m_counts.m_contacts > m_limits.m_contacts) return;
    sortContacts(m_found);
    contacts.insert(contacts.end(), m_found.begin(), m_found.end());
}

void HostSelfTrees::update(const SelfStep& step)
{
    const MeshPool& cloths = step.m_cloths;
    if (m_revision != cloths.revision())
    {
        m_revision = cloths.revision();
        m_layout = makeBvhLayout(std::uint32_t(cloths.triangles().size()));
        m_nodes = makeBvhNodes(m_layout);
        m_order = joinedOrder(cloths);
    }
    std::size_t ignored = 0;
    refitOnHost(m_nodes, m_layout, m_order, cloths.triangles(), step.start(), step.m_view.m_cloth.m_end,
                step.m_reach.m_radius, ignored);
    selfVolumes(step, m_volumes);
}

SelfCounts HostSelfTrees::run(const SelfStep& step, SelfStepLimits limits, std::vector<Contact>& contacts)
{
    update(step);
    SelfFinder finder(step, m_volumes, limits);
    const HostTree tree = {m_nodes, m_layout, m_order, step.m_cloths.triangles()};
    leafPairsOnHost(
        tree, tree, DRAPE_WALK_SELF, [&](const Candidate& pair) { finder.visit(pair); },
        [&] { return finder.withinLimits(); });
    finder.append(contacts);
    SelfCounts counts = finder.counts();
    counts.m_invalidNodes = invalidNodes(step);
    return counts;
}
}  // namespace drape
