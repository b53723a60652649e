#include "cloth_rows.h"

#include <algorithm>

#include "kernels/lib/cloth_cloth/self_contact.h"
#include "kernels/lib/solver/acting_contact.h"

namespace drape
{
namespace
{
// Distance between two features, as a share of the thickness, below which the direction between them is not sure.
constexpr float kSureDistance = 0.01f;

// Distance beyond the resting one, as a share of the thickness, within which features may meet in a phase's sweeps.
constexpr float kNearBy = 0.25f;

// Writes the weights of the nearest points of two features: positive for the first one's nodes, negative for the
// second's. positions: m.
void nearestWeights(const Vec3 positions[4], int split, float weights[4])
{
    if (split == 1)
    {
        FeatureTriangle face;
        for (int i = 0; i < 3; ++i)
            face.m_p[i] = vec3Sub(positions[1 + i], positions[0]);
        const int thin = isThin(face, vec3Length(triangleNormal(face)));
        const Vec3 at = closestOnFace(vec3(0.0f, 0.0f, 0.0f), face, thin);
        const float all[4] = {1.0f, -at.x, -at.y, -at.z};
        std::copy(all, all + 4, weights);
        return;
    }
    float s, t;
    edgesClosest(edgesFrom(positions), &s, &t);
    const float all[4] = {1.0f - s, s, t - 1.0f, -t};
    std::copy(all, all + 4, weights);
}
}  // namespace

Vec3 ClothRows::startOf(const ClothContact& contact, int k)
{
    return contact.m_cloths[k] ? contact.m_cloths[k]->start(contact.m_nodes[k]) : contact.m_resting[k];
}

Vec3 ClothRows::displacementOf(const ClothContact& contact, int k)
{
    return contact.m_cloths[k] ? contact.m_cloths[k]->displacement(contact.m_nodes[k]) : vec3(0.0f, 0.0f, 0.0f);
}

float ClothRows::inverseMassOf(const ClothContact& contact, int k)
{
    return contact.m_cloths[k] ? contact.m_cloths[k]->inverseMass(contact.m_nodes[k]) : 0.0f;
}

void ClothRows::add(const ClothContact& contact)
{
    Row row = {};
    row.m_contact = contact;
    const float gap = contact.m_gap0 - contact.m_thickness;
    row.m_distance = contact.m_thickness + targetGap(gap, 0.0f, contact.m_thickness);
    row.m_row.m_normal = contact.m_normal;
    row.m_row.m_friction = contact.m_friction;
    row.m_row.m_mended = 1.0f;
    m_rows.push_back(row);
}

// Takes the row's plane between the nearest points of the features as they are.
void ClothRows::takePlane(Row& row, float passed)
{
    const ClothContact& contact = row.m_contact;
    Vec3 positions[4], offset = vec3(0.0f, 0.0f, 0.0f), apart = offset;
    for (int k = 0; k < 4; ++k)
        positions[k] = vec3Add(startOf(contact, k), displacementOf(contact, k));
    nearestWeights(positions, contact.m_split, row.m_weights);
    float mobility = 0.0f;
    for (int k = 0; k < 4; ++k)
    {
        // Weights add up to 0: offsets from one node have less rounding than positions.
        apart = vec3AddScaled(apart, vec3Sub(positions[k], positions[0]), row.m_weights[k]);
        offset = vec3AddScaled(offset, vec3Sub(startOf(contact, k), startOf(contact, 0)), row.m_weights[k]);
        mobility += row.m_weights[k] * row.m_weights[k] * inverseMassOf(contact, k);
    }
    const float distance = vec3Length(apart);
    if (distance > kSureDistance * contact.m_thickness)
    {
        // Features pass each other where both are nearest inside. A node beside a face went around it.
        const bool inside = std::all_of(row.m_weights, row.m_weights + 4, [](float weight) { return weight != 0.0f; });
        const bool hasPassed = inside && vec3Dot(apart, row.m_row.m_normal) < 0.0f;
        row.m_row.m_normal = vec3Scale(apart, (hasPassed ? -1.0f : 1.0f) / distance);
    }
    const float distance0 = std::min(contact.m_gap0, row.m_distance);
    row.m_row.m_inverseMobility = mobility > 0.0f ? 1.0f / mobility : 0.0f;
    row.m_row.m_level = distance0 + passed * (row.m_distance - distance0) - vec3Dot(row.m_row.m_normal, offset);
}

// Returns the row's displacement, m.
Vec3 ClothRows::wayOf(const Row& row)
{
    Vec3 way = vec3(0.0f, 0.0f, 0.0f);
    for (int k = 0; k < 4; ++k)
        way = vec3AddScaled(way, displacementOf(row.m_contact, k), row.m_weights[k]);
    return way;
}

bool ClothRows::isNear(const Row& row)
{
    const float violation = row.m_row.m_level - vec3Dot(row.m_row.m_normal, wayOf(row));
    return row.m_row.m_inverseMobility > 0.0f && violation > -kNearBy * row.m_contact.m_thickness;
}

void ClothRows::begin(float passed)
{
    m_near.clear();
    for (std::size_t i = 0; i < m_rows.size(); ++i)
    {
        Row& row = m_rows[i];
        row.m_row.m_multiplier = 0.0f;
        row.m_row.m_held = vec3(0.0f, 0.0f, 0.0f);
        takePlane(row, passed);
        if (isNear(row)) m_near.push_back(std::uint32_t(i));
    }
}

// Moves the row's nodes. by: kg m.
void ClothRows::push(Row& row, Vec3 by)
{
    const ClothContact& contact = row.m_contact;
    for (int k = 0; k < 4; ++k)
        if (const float inverseMass = inverseMassOf(contact, k); inverseMass > 0.0f)
            contact.m_cloths[k]->shift(contact.m_nodes[k], vec3Scale(by, row.m_weights[k] * inverseMass));
}

float ClothRows::project(float relaxation, float tolerated)
{
    float worst = 0.0f;
    for (const std::uint32_t index : m_near)
    {
        Row& row = m_rows[index];
        const float thickness = row.m_contact.m_thickness;
        float violation = 0.0f;
        Vec3 by;
        if (pushRow(&row.m_row, wayOf(row), 1.0f, tolerated * thickness, relaxation, &violation, &by)) push(row, by);
        worst = std::max(worst, violation / thickness);
    }
    return worst;
}

void ClothRows::limitSpeeds(float perSecond)
{
    for (const Row& row : m_rows)
    {
        const ClothContact& contact = row.m_contact;
        const float recovered = row.m_distance - contact.m_gap0;
        if (!(contact.m_gap0 < contact.m_thickness) || !(row.m_row.m_inverseMobility > 0.0f)) continue;
        float speed = 0.0f;
        for (int k = 0; k < 4; ++k)
            if (contact.m_cloths[k])
                speed +=
                    row.m_weights[k] * vec3Dot(contact.m_cloths[k]->velocity(contact.m_nodes[k]), row.m_row.m_normal);
        const float excess = std::min(speed, std::max(0.0f, recovered) * perSecond);
        if (!(excess > 0.0f)) continue;
        const Vec3 loss = vec3Scale(row.m_row.m_normal, -excess * row.m_row.m_inverseMobility);
        for (int k = 0; k < 4; ++k)
            if (const float inverseMass = inverseMassOf(contact, k); inverseMass > 0.0f)
                contact.m_cloths[k]->addVelocity(contact.m_nodes[k], vec3Scale(loss, row.m_weights[k] * inverseMass));
    }
}
}  // namespace drape
