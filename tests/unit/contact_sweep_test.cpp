// Contact sweeps that skip most contacts and run on several threads equal sweeps that project every contact in turn,
// bit for bit.
#include "bullet_plugin/core/scene/scene.h"
#include "bullet_plugin/core/solver/host/contact_sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/support/pipeline_driver.h"
#include "tests/unit/plain_sweep.h"

namespace drape::test
{
namespace
{
constexpr float kThickness = 0.02f;  // m

enum class Motion
{
    Rests,
    Turns,
    Deforms
};

struct SweepCase
{
    std::string m_name;
    Motion m_motion;
    unsigned m_threads;
    bool m_inParts;  // each phase runs later in the step, in turns with links; else at the step's end
};

// Writes a rotation by 0.02 about (1, 2, 3) and a shift.
void writeTurn(float map[12])
{
    const float angle = 0.02f, length = std::sqrt(14.0f), c = std::cos(angle), s = std::sin(angle);
    const float axis[3] = {1 / length, 2 / length, 3 / length}, shift[3] = {0.01f, 0, 0.02f};
    for (int i = 0; i < 3; ++i)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        map[4 * i + i] = c + (1 - c) * axis[i] * axis[i];
        map[4 * i + j] = (1 - c) * axis[i] * axis[j] - s * axis[k];
        map[4 * i + k] = (1 - c) * axis[i] * axis[k] + s * axis[j];
        map[4 * i + 3] = shift[i];
    }
}

// Waves along x and z.
std::vector<Vec3> deformed(const SolverNodes& nodes)
{
    std::vector<Vec3> starts;
    for (std::size_t i = 0; i < nodes.count(); ++i)
    {
        const Vec3 start = nodes.start(i);
        starts.push_back(vec3Add(start, vec3(0.01f * std::sin(4 * start.z), 0.015f * std::cos(5 * start.x), 0.005f)));
    }
    return starts;
}

std::vector<FeatureContacts> featuresOf(const Pipeline& pipeline, const FeatureOrder& order,
                                        const std::vector<Contact>& contacts)
{
    std::vector<FeatureContacts> features;
    for (const Contact& contact : contacts)
    {
        const ClothFeature cloth = pipeline.clothFeature(contact);
        if (features.empty() || features.back().m_contacts->m_featureIndex != contact.m_featureIndex)
            features.push_back({&contact, 0, &order.features()[cloth.m_index], 1});
        ++features.back().m_count;
    }
    return features;
}

// A cloth that has shaken through a terrain, with its contacts.
class SweptScene
{
public:
    explicit SweptScene(Motion motion)
    {
        Settings settings;
        settings.m_backend = Backend::Host;
        Error error;
        m_pipeline = Pipeline::create(settings, error);
        const TriangleMesh grid = makeClothGrid(65, 65, 2.0f, 0.032f).m_mesh;
        const MeshId cloth = addCloth(*m_pipeline, grid);
        const MeshId ground = addObstacle(*m_pipeline, makeTerrain(2.4f, 0.01f, 192, 7));
        Random random(20);
        std::vector<float> start = grid.m_positions, end = start;
        for (std::size_t i = 0; i < end.size(); ++i)
        {
            start[i] += random.uniform(-0.012f, 0.012f);
            end[i] += random.uniform(-0.012f, 0.012f);
        }
        setMotion(*m_pipeline, cloth, start, end);
        m_pipeline->addPair(cloth, ground, kThickness);
        m_contacts = runStep(*m_pipeline);

        setCloth(cloth, start, end);
        ObstacleSurface surface;
        surface.m_moves = motion == Motion::Turns;
        writeTurn(surface.m_map);
        surface.m_friction = 0.5f;
        m_source.set(m_pipeline->scene(), m_pipeline->pairs(), {});
        m_source.nameObstacle(ground, surface);
        m_starts = deformed(m_cloth.m_nodes);
        if (motion == Motion::Deforms) m_source.nameStarts(cloth, m_starts.data());
        const Vec3 far = vec3(2, 2, 2);
        m_cloth.m_limit.addObstacle(vec3Scale(far, -1), far, kThickness, 0.5f,
                                    {m_source.mapOf(ground), motion == Motion::Deforms ? m_starts.data() : nullptr});
        nameContacts();
    }

    const std::vector<Contact>& contacts() const { return m_contacts; }

    ClothContacts m_cloth;
    ContactSource m_source;

private:
    void setCloth(MeshId cloth, const std::vector<float>& start, const std::vector<float>& end)
    {
        const std::uint32_t count = std::uint32_t(start.size() / 3);
        SolverNodes& nodes = m_cloth.m_nodes;
        nodes.resize(count);
        std::vector<Vec3> places;
        for (std::uint32_t i = 0; i < count; ++i)
        {
            const Vec3 from = vec3Load(start.data(), i), to = vec3Load(end.data(), i);
            nodes.setPath(i, from, vec3Sub(to, from), vec3(0, 0, 0), i % 7 == 0 ? 0.0f : 100.0f, i % 11 == 3);
            places.push_back(to);
        }
        m_parts.cut(places);
        m_order.build(m_parts, m_pipeline->scene().m_cloths.existing(cloth).m_topology);
        m_cloth.start(cloth, m_parts, &m_order);
        m_cloth.m_leastThickness = m_cloth.m_mostThickness = kThickness;
        m_cloth.m_friction = 0.6f;
        m_cloth.m_hardness = 0.1f;
        m_cloth.m_perSecond = 60;
    }
    void nameContacts()
    {
        m_cloth.m_features = featuresOf(*m_pipeline, m_order, m_contacts);
        m_noFaces = ClothFaces({}, m_cloth.m_nodes.count());
        m_cloth.m_limit.startStep(m_noFaces);
        for (const FeatureContacts& feature : m_cloth.m_features)
            for (int k = 0; k < 3 && feature.nodes()[k] >= 0; ++k)
                m_cloth.m_limit.addContactNode(feature.nodes()[k]);
    }

    std::unique_ptr<Pipeline> m_pipeline;
    ClothParts m_parts;
    FeatureOrder m_order;
    ClothFaces m_noFaces;
    std::vector<Vec3> m_starts;  // carried by the obstacle
    std::vector<Contact> m_contacts;
};

void expectSameNodes(const SolverNodes& nodes, const PlainSweep& plain)
{
    for (std::size_t i = 0; i < nodes.count(); ++i)
    {
        const Vec3 pairs[2][2] = {{nodes.displacement(i), plain.places()[i]},
                                  {nodes.velocity(i), plain.velocities()[i]}};
        for (const auto& [a, b] : pairs)
        {
            ASSERT_EQ(a.x, b.x) << "node " << i;
            ASSERT_EQ(a.y, b.y) << "node " << i;
            ASSERT_EQ(a.z, b.z) << "node " << i;
        }
    }
}

constexpr std::size_t kSweeps = 24, kPhase = 4;  // sweeps in all and in a phase

// Runs a sweep of both. The third of each phase visits nodes alone.
void runBoth(SweepTeam& team, ContactSweep& sweep, PlainSweep& plain, std::size_t at, bool inParts)
{
    const SweepTeam::Cloths cloths{&sweep};
    if (at % kPhase == 0)
    {
        const float passed = inParts ? float(at / kPhase + 1) / float(kSweeps / kPhase) : 1;
        sweep.restart(passed, inParts ? DRAPE_ACTING_SWEEPS : 0);
        plain.restart(passed, inParts);
    }
    if (at % kPhase == 2)
    {
        team.runNodes(cloths);
        ASSERT_EQ(SweepTeam::worst(sweep), plain.runNodes());
        return;
    }
    team.run(cloths);
    ASSERT_EQ(SweepTeam::worst(sweep), plain.run());
}

// The test moves nodes at random between the sweeps, as links do, so that contacts become active and inactive.
void runAll(SweepTeam& team, ContactSweep& sweep, PlainSweep& plain, std::size_t contacts, bool inParts)
{
    Random random(21);
    SCOPED_TRACE("seed 21");
    const auto noise = [&random] { return random.uniform(-0.012f, 0.012f); };
    SolverNodes& nodes = sweep.nodes();
    std::size_t pushed = 0;
    for (std::size_t at = 0; at < kSweeps; ++at)
    {
        SCOPED_TRACE("sweep " + std::to_string(at));
        for (std::size_t i = 0; i < nodes.count(); ++i)
        {
            const float x = noise(), y = noise(), z = noise();
            nodes.shift(i, vec3(x, y, z));
            plain.move(i, vec3(x, y, z));
            nodes.remember(i);
        }
        ASSERT_NO_FATAL_FAILURE(runBoth(team, sweep, plain, at, inParts));
        for (std::size_t i = 0; i < nodes.count(); ++i)
            nodes.addShift(i, sweep.contacts().m_perSecond);
        ASSERT_NO_FATAL_FAILURE(expectSameNodes(nodes, plain));
        pushed += plain.pushed();
        EXPECT_LT(plain.pushed(), contacts / 2);
    }
    EXPECT_GT(pushed, kSweeps * contacts / 50);
    EXPECT_GT(plain.renewed(), 10u);
    EXPECT_EQ(plain.early() > 10, inParts);
}

class ContactSweepTest : public testing::TestWithParam<SweepCase>
{
};
}  // namespace

TEST_P(ContactSweepTest, SweepsEqualTheOracleOverEveryContact)
{
    SCOPED_TRACE("seed 20");
    SweptScene scene(GetParam().m_motion);
    ASSERT_GT(scene.contacts().size(), 2048u);  // in more blocks than threads begin to share at
    ASSERT_EQ(scene.m_cloth.m_parts->leafCount(), 4u);

    ThreadTeam threads(GetParam().m_threads);
    SweepTeam team(threads);
    SolverCloth cloth;
    cloth.m_contacts = &scene.m_cloth;
    ContactSweep sweep;
    sweep.assign(cloth, scene.m_source);
    sweep.begin();
    team.start({&sweep});
    PlainSweep plain(scene.m_cloth, scene.m_source, scene.contacts());
    ASSERT_NO_FATAL_FAILURE(runAll(team, sweep, plain, scene.contacts().size(), GetParam().m_inParts));
    team.limitSpeeds({&sweep});
    plain.limitSpeeds();
    expectSameNodes(sweep.nodes(), plain);
    EXPECT_GT(plain.slowed(), 5u);
    EXPECT_EQ(SweepTeam::mayHavePassed(sweep), plain.mayHavePassed());
}

INSTANTIATE_TEST_SUITE_P(Obstacle, ContactSweepTest,
                         testing::Values(SweepCase{"rests", Motion::Rests, 1, false},
                                         SweepCase{"turns", Motion::Turns, 1, false},
                                         SweepCase{"turnsInParts", Motion::Turns, 1, true},
                                         SweepCase{"deformsInParts", Motion::Deforms, 1, true},
                                         SweepCase{"restsThreads", Motion::Rests, 3, false},
                                         SweepCase{"turnsThreads", Motion::Turns, 8, false},
                                         SweepCase{"turnsInPartsThreads", Motion::Turns, 3, true}),
                         [](const auto& sweep) { return sweep.param.m_name; });
}  // namespace drape::test
