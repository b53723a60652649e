// Contact rounds that skip most contacts and run on several threads equal rounds that project every contact in turn,
// bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "bullet_plugin/adapter/contact_rounds.h"
#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/pipeline_driver.h"

namespace drape::test
{
namespace
{
// Projects every contact, without any short cut. The order is group by group of the cloth, children first, each in
// canonical order. Edges come after all others in a round.
class PlainRounds
{
public:
    PlainRounds(btSoftBody& body, const ClothParts& parts, const NodePaths& paths, const FoundContacts& found,
                const std::vector<Contact>& contacts)
        : m_body(body), m_paths(paths), m_found(found), m_detected(contacts), m_rows(contacts.size())
    {
        const auto groupOf = [&](const Contact& contact)
        { return parts.groupOf(found.resolve(body, paths, contact).m_nodes); };
        std::stable_sort(m_detected.begin(), m_detected.end(),
                         [&](const Contact& a, const Contact& b) { return groupOf(a) > groupOf(b); });
        for (std::size_t i = 0; i < m_detected.size(); ++i)
        {
            m_contacts.push_back(found.resolve(body, paths, m_detected[i]));
            m_rows[i].m_speedLimit = speedLimitOf(m_contacts[i]);
        }
    }

    void restart()
    {
        for (Row& row : m_rows)
        {
            row.m_multiplier = 0;
            row.m_held.setZero();
            row.m_renewed = row.m_acted = false;
        }
    }

    btScalar run()
    {
        std::vector<btVector3> x = places();
        const btScalar worst = runAll(x);
        store(x);
        return worst;
    }

    void runAndSettle()
    {
        std::vector<btVector3> x = places();
        runAll(x);
        for (int pass = 0; pass < RoundsTeam::kSettlingPasses; ++pass)
            for (std::size_t i = 0; i < m_rows.size(); ++i)
                if (m_rows[i].m_acted && m_rows[i].m_settles) project(m_contacts[i], m_rows[i], x);
        store(x);
    }

    void limitSpeeds()
    {
        for (std::size_t i = 0; i < m_rows.size(); ++i)
        {
            const StepContact& contact = m_contacts[i];
            btScalar speed = 0;
            for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
                speed += m_body.m_nodes[contact.m_nodes[k]].m_v.dot(contact.m_normal) * contact.m_weights[k];
            const btScalar excess = speed - m_rows[i].m_speedLimit, mobility = softenedOf(contact);
            if (!m_rows[i].m_everActed || !(excess > 0) || !(mobility > 0)) continue;
            ++m_slowed;
            for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
                m_body.m_nodes[contact.m_nodes[k]].m_v -=
                    contact.m_normal * (shareOf(contact, k) * excess * (1 / mobility));
        }
    }

    std::size_t slowed() const { return m_slowed; }
    std::size_t renewed() const { return m_renewed; }
    std::size_t pushed() const
    {
        return static_cast<std::size_t>(
            std::count_if(m_rows.begin(), m_rows.end(), [](const Row& row) { return row.m_multiplier > 0; }));
    }

private:
    struct Row
    {
        btScalar m_multiplier = 0;
        btVector3 m_held = btVector3(0, 0, 0);
        bool m_renewed = false;
        bool m_acted = false;      // violated or holding when it was looked at
        bool m_everActed = false;  // in any stage
        bool m_settles = false;    // its plane was renewed in any stage
        btScalar m_speedLimit = 0;
    };

    std::vector<btVector3> places() const
    {
        std::vector<btVector3> x;
        for (int i = 0; i < m_body.m_nodes.size(); ++i)
            x.push_back(m_body.m_nodes[i].m_x);
        return x;
    }

    void store(const std::vector<btVector3>& x)
    {
        for (int i = 0; i < m_body.m_nodes.size(); ++i)
        {
            btSoftBody::Node& node = m_body.m_nodes[i];
            const btVector3& place = x[std::size_t(i)];
            node.m_v += (place - node.m_x) * (m_body.m_sst.isdt * (1 - m_body.m_cfg.kDP));
            node.m_x = place;
        }
    }

    btScalar runAll(std::vector<btVector3>& x)
    {
        btScalar worst = 0;
        for (const bool edges : {false, true})
        {
            for (std::size_t i = 0; i < m_rows.size(); ++i)
            {
                if ((m_contacts[i].m_nodes[1] >= 0 && m_contacts[i].m_nodes[2] < 0) != edges) continue;
                renewPlane(i, x);
                worst = std::max(worst, project(m_contacts[i], m_rows[i], x));
            }
        }
        return worst;
    }

    // Returns the position of the contact's cloth point at the step's start, which is the origin of all its
    // coordinates.
    btVector3 startOf(const StepContact& contact) const
    {
        return pointOf(contact, m_paths.m_start, btVector3(0, 0, 0));
    }

    // Returns the displacement that the obstacle's motion gives to that point.
    static btVector3 carriedFrom(const StepContact& contact, const btVector3& start)
    {
        return contact.m_carry ? *contact.m_carry * start - start : btVector3(0, 0, 0);
    }

    // Outwards: what recovering a depth that the step began with takes, beside the obstacle's own.
    btScalar speedLimitOf(const StepContact& contact) const
    {
        if (!(contact.m_startGap < 0)) return SIMD_INFINITY;
        const btScalar carried = contact.m_normal.dot(carriedFrom(contact, startOf(contact)));
        return (std::max(btScalar(0), contact.m_endGap - contact.m_startGap) + carried) * m_body.m_sst.isdt;
    }

    btScalar violationOf(const StepContact& contact, const btVector3& start, const std::vector<btVector3>& x) const
    {
        const btScalar level =
            contact.m_normal.dot(contact.m_point - start) + (contact.m_thickness + contact.m_targetGap);
        return level - contact.m_normal.dot(pointOf(contact, x, -start));
    }

    void renewPlane(std::size_t i, const std::vector<btVector3>& x)
    {
        StepContact& contact = m_contacts[i];
        const bool violated = violationOf(contact, startOf(contact), x) > 0;
        if (m_rows[i].m_renewed || !(mobilityOf(contact) > 0) || !violated) return;
        m_rows[i].m_renewed = true;
        float nodes[3][3];
        for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
            for (int axis = 0; axis < 3; ++axis)
                nodes[k][axis] = float(x[static_cast<std::size_t>(contact.m_nodes[k])][axis]);
        ContactPlane plane;
        if (!FoundContacts::planeAt(m_detected[i], nodes, plane)) return;
        ++m_renewed;
        m_rows[i].m_settles = true;
        contact.m_normal.setValue(plane.m_normal[0], plane.m_normal[1], plane.m_normal[2]);
        contact.m_point.setValue(plane.m_point[0], plane.m_point[1], plane.m_point[2]);
        for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
            contact.m_weights[k] = plane.m_weights[k];
    }

    static btVector3 pointOf(const StepContact& contact, const std::vector<btVector3>& x, btVector3 point)
    {
        for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
            point += x[static_cast<std::size_t>(contact.m_nodes[k])] * contact.m_weights[k];
        return point;
    }

    void shift(const StepContact& contact, const btVector3& impulse, std::vector<btVector3>& x) const
    {
        for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
            x[static_cast<std::size_t>(contact.m_nodes[k])] += impulse * shareOf(contact, k);
    }

    btScalar shareOf(const StepContact& contact, int k) const
    {
        return contact.m_weights[k] * movableInverseMass(m_body.m_nodes[contact.m_nodes[k]]);
    }

    btScalar mobilityOf(const StepContact& contact) const
    {
        btScalar mobility = 0;
        for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
            mobility +=
                contact.m_weights[k] * contact.m_weights[k] * movableInverseMass(m_body.m_nodes[contact.m_nodes[k]]);
        return mobility;
    }

    // Returns the mobility that pushes use. It exceeds its proportional value if a part of the point is held.
    btScalar softenedOf(const StepContact& contact) const
    {
        const btScalar mobility = mobilityOf(contact);
        btScalar held = 0, most = 0;
        for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        {
            const btScalar inverseMass = movableInverseMass(m_body.m_nodes[contact.m_nodes[k]]);
            if (inverseMass == 0) held += contact.m_weights[k];
            most = std::max(most, inverseMass);
        }
        return mobility > 0 ? mobility + kHeldSoftness * held * most : btScalar(0);
    }

    // Returns what of the violation the push takes away.
    btScalar project(const StepContact& contact, Row& row, std::vector<btVector3>& x) const
    {
        const btVector3 normal = contact.m_normal, start = startOf(contact);
        const btScalar mobility = softenedOf(contact), violation = violationOf(contact, start, x);
        if (!(mobility > 0) || (!(violation > 0) && !(row.m_multiplier > 0))) return 0;
        row.m_acted = row.m_everActed = true;
        const btScalar inverse = 1 / mobility;
        const btScalar pushed = std::max(btScalar(0), row.m_multiplier + violation * inverse);
        const btVector3 way = pointOf(contact, x, -start), carried = carriedFrom(contact, start);
        const btVector3 along = normal * normal.dot(way), slid = carried - normal * normal.dot(carried);
        btVector3 held = row.m_held - (way - along - slid) * inverse;
        const btScalar most = contact.m_friction * pushed, wanted2 = held.length2();
        if (wanted2 > most * most) held *= most / btSqrt(wanted2);
        shift(contact, normal * (pushed - row.m_multiplier) + (held - row.m_held), x);
        row.m_multiplier = pushed;
        row.m_held = held;
        return mobilityOf(contact) == mobility ? violation : violation * (mobilityOf(contact) * inverse);
    }

    btSoftBody& m_body;
    const NodePaths& m_paths;
    const FoundContacts& m_found;
    std::vector<Contact> m_detected;
    std::vector<StepContact> m_contacts;
    std::vector<Row> m_rows;
    std::size_t m_renewed = 0, m_slowed = 0;
};

std::unique_ptr<btSoftBody> makeBody(btSoftBodyWorldInfo& info, const std::vector<float>& start,
                                     const std::vector<float>& end)
{
    std::vector<btVector3> places;
    std::vector<btScalar> masses;
    for (std::size_t i = 0; i < end.size(); i += 3)
    {
        places.emplace_back(end[i], end[i + 1], end[i + 2]);
        masses.push_back(i % 21 == 0 ? btScalar(0) : btScalar(0.01));
    }
    auto made = std::make_unique<btSoftBody>(&info, static_cast<int>(places.size()), places.data(), masses.data());
    btSoftBody& body = *made;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        body.m_nodes[i].m_q =
            btVector3(start[std::size_t(3 * i)], start[std::size_t(3 * i + 1)], start[std::size_t(3 * i + 2)]);
    body.m_sst.sdt = kDt;
    body.m_sst.isdt = 1 / kDt;
    body.m_cfg.kDF = btScalar(0.6);
    return made;
}

std::vector<btVector3> placesOf(const btSoftBody& body)
{
    std::vector<btVector3> places;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        places.push_back(body.m_nodes[i].m_x);
    return places;
}

std::vector<FeatureContacts> featuresOf(const Pipeline& pipeline, const std::vector<Contact>& contacts)
{
    std::vector<FeatureContacts> features;
    for (const Contact& contact : contacts)
    {
        const ClothFeature cloth = pipeline.clothFeature(contact);
        if (features.empty() || features.back().m_contacts->m_slot != contact.m_slot)
            features.push_back({&contact, 0, {cloth.m_nodes[0], cloth.m_nodes[1], cloth.m_nodes[2]}, 1});
        ++features.back().m_count;
    }
    return features;
}

void expectSameNodes(const btSoftBody& a, const btSoftBody& b)
{
    for (int i = 0; i < a.m_nodes.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
        {
            ASSERT_EQ(a.m_nodes[i].m_x[axis], b.m_nodes[i].m_x[axis]) << "node " << i;
            ASSERT_EQ(a.m_nodes[i].m_v[axis], b.m_nodes[i].m_v[axis]) << "node " << i;
        }
}

// Runs a round of both. Every fourth begins anew, and the one after it settles.
void runBoth(RoundsTeam& team, ContactRounds& rounds, PlainRounds& plain, std::size_t round)
{
    const RoundsTeam::Bodies bodies{&rounds};
    team.gather(bodies);
    if (round % 4 == 0)
    {
        rounds.restart();
        plain.restart();
    }
    if (round % 4 != 1)
    {
        team.run(bodies);
        ASSERT_EQ(RoundsTeam::worst(rounds), plain.run());
    }
    else
    {
        team.runAndSettle(bodies);
        plain.runAndSettle();
    }
    team.scatter(bodies);
}

// The test moves nodes at random between the rounds, as links do, so that contacts become active and inactive.
void runAll(RoundsTeam& team, ContactRounds& rounds, PlainRounds& plain, btSoftBody& plainBody, std::size_t contacts,
            Random& random)
{
    btSoftBody& body = *rounds.contacts().m_body;
    const auto noise = [&random] { return random.uniform(-0.012f, 0.012f); };
    constexpr std::size_t kRounds = 24;
    std::size_t pushed = 0;
    for (std::size_t round = 0; round < kRounds; ++round)
    {
        SCOPED_TRACE("round " + std::to_string(round));
        for (int i = 0; i < body.m_nodes.size(); ++i)
        {
            const btVector3 pull(noise(), noise(), noise());
            body.m_nodes[i].m_x += pull;
            plainBody.m_nodes[i].m_x += pull;
        }
        ASSERT_NO_FATAL_FAILURE(runBoth(team, rounds, plain, round));
        ASSERT_NO_FATAL_FAILURE(expectSameNodes(body, plainBody));
        pushed += plain.pushed();
        EXPECT_LT(plain.pushed(), contacts / 2);
    }
    EXPECT_GT(pushed, kRounds * contacts / 50);
    EXPECT_GT(plain.renewed(), 10u);
}

struct RoundsCase
{
    std::string m_name;
    BodyMotion m_motion;
    unsigned m_threads;
};

const BodyMotion kRests{btTransform::getIdentity(), btTransform::getIdentity()};
const BodyMotion kTurns{btTransform::getIdentity(),
                        btTransform(btQuaternion(btVector3(1, 2, 3).normalized(), 0.02f), btVector3(0.01f, 0, 0.02f))};

class ContactRoundsTest : public testing::TestWithParam<RoundsCase>
{
};
}  // namespace

TEST_P(ContactRoundsTest, RoundsEqualTheOracleOverEveryContact)
{
    Error error;
    const std::unique_ptr<Pipeline> pipeline = Pipeline::create(hostSettings(), error);
    const TriangleMesh grid = makeClothGrid(65, 65, 2.0f, 0.032f).m_mesh;
    const MeshId cloth = addCloth(*pipeline, grid), ground = addObstacle(*pipeline, makeTerrain(2.4f, 0.01f, 192, 7));
    Random random(20);
    SCOPED_TRACE("seed 20");
    const auto noise = [&random] { return random.uniform(-0.012f, 0.012f); };
    std::vector<float> start = grid.m_positions, end = start;
    for (std::size_t i = 0; i < end.size(); ++i)
    {
        start[i] += noise();
        end[i] += noise();
    }
    setMotion(*pipeline, cloth, start, end);
    pipeline->addPair(cloth, ground, kThickness);
    const std::vector<Contact> contacts = runStep(*pipeline);
    ASSERT_GT(contacts.size(), 2048u);  // in more blocks than threads begin to share at

    btSoftBodyWorldInfo info;
    const std::unique_ptr<btSoftBody> made = makeBody(info, start, end), plainMade = makeBody(info, start, end);
    btSoftBody &body = *made, &plainBody = *plainMade;
    btCollisionObject object;
    FoundContacts found;
    found.nameObstacle(ground, &object, GetParam().m_motion);
    found.set(*pipeline, ContactList{contacts.data(), contacts.size()});
    ClothParts parts;
    parts.cut(placesOf(body));
    ASSERT_EQ(parts.leafCount(), 4u);
    BodyContacts bodyContacts;
    bodyContacts.start(cloth, &body, parts);
    bodyContacts.m_leastThickness = bodyContacts.m_mostThickness = kThickness;
    const ClothFaces noFaces({}, parts.nodeCount());
    bodyContacts.m_limit.record(body, noFaces);
    bodyContacts.m_features = featuresOf(*pipeline, contacts);

    ThreadTeam threads(GetParam().m_threads);
    RoundsTeam team(threads);
    ContactRounds rounds;
    rounds.assign(bodyContacts, found);
    rounds.begin();
    team.start({&rounds});
    PlainRounds plain(plainBody, parts, bodyContacts.m_limit.paths(), found, contacts);
    ASSERT_NO_FATAL_FAILURE(runAll(team, rounds, plain, plainBody, contacts.size(), random));
    team.limitSpeeds({&rounds});
    plain.limitSpeeds();
    expectSameNodes(body, plainBody);
    EXPECT_GT(plain.slowed(), 5u);
}

INSTANTIATE_TEST_SUITE_P(Obstacle, ContactRoundsTest,
                         testing::Values(RoundsCase{"rests", kRests, 1}, RoundsCase{"turns", kTurns, 1},
                                         RoundsCase{"restsThreads", kRests, 3}, RoundsCase{"turnsThreads", kTurns, 8}),
                         [](const auto& round) { return round.param.m_name; });
}  // namespace drape::test
