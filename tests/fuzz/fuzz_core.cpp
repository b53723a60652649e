// Fuzzes meshes, motions and settings on the host back end, over some steps with meshes that are added, removed and
// moved.
//
// Expects no crash, no undefined behaviour, and contacts that are finite, unit, in canonical order and within the
// limits. A mesh with an index out of range is refused. Contacts of an automatic step equal those of a continuous one.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <tuple>
#include <vector>

#include "bullet_plugin/core/pipeline/pipeline.h"
#include "scenes/describe_mesh.h"
#include "tests/fuzz/bytes.h"

namespace
{
using drape::fuzz::AnyMesh;
using drape::fuzz::Bytes;
using drape::fuzz::require;

struct Mesh
{
    drape::MeshId m_id;
    std::vector<float> m_positions;
    bool m_self;
};

constexpr std::size_t kMostMeshes = 4;

// Settings that apply to a whole input.
struct Choices
{
    drape::Settings m_settings;
    bool m_badIndices, m_self;
};

// A cloth that collides with itself, its nodes at rest where they are or anywhere.
void chooseSelf(Bytes& bytes, drape::MeshDescription& description, std::vector<float>& rest)
{
    description.m_selfThickness = bytes.length();
    if (bytes.below(2) == 0) return;
    for (std::size_t i = 0; i < 3 * description.m_vertexCount; ++i)
        rest.push_back(bytes.number());
    description.m_restPositions = rest.data();
}

void addMesh(drape::Pipeline& pipeline, Bytes& bytes, const Choices& choices, bool cloth, std::vector<Mesh>& meshes)
{
    const AnyMesh mesh(bytes, choices.m_badIndices);
    drape::MeshDescription description = describeMesh(mesh);
    description.m_oneSided = !cloth && bytes.below(4) == 0;
    std::vector<float> rest;
    if (cloth && choices.m_self) chooseSelf(bytes, description, rest);
    const drape::MeshId id = cloth ? pipeline.addCloth(description) : pipeline.addObstacle(description);
    require((id != drape::kNoMesh) == mesh.m_inRange);
    require(mesh.m_inRange || pipeline.lastError().failed());
    if (mesh.m_inRange) meshes.push_back(Mesh{id, mesh.m_positions, description.m_selfThickness > 0.0f});
}

// Two poses of an obstacle; mostly rigid, sometimes not.
void place(drape::Pipeline& pipeline, Bytes& bytes, const Mesh& obstacle)
{
    float poses[2][12] = {};
    for (float(&pose)[12] : poses)
    {
        const float angle = bytes.number(), cosine = std::cos(angle), sine = std::sin(angle);
        pose[0] = pose[5] = cosine;
        pose[1] = -sine;
        pose[4] = sine;
        pose[10] = 1;
        for (int axis = 0; axis < 3; ++axis)
            pose[4 * axis + 3] = bytes.number();
        if (bytes.below(8) == 0) pose[bytes.below(12)] = bytes.number();
    }
    pipeline.placeObstacle(obstacle.m_id, poses[0], poses[1]);
}

void change(drape::Pipeline& pipeline, Bytes& bytes, const Choices& choices, std::vector<Mesh>& meshes, bool cloth)
{
    const std::uint32_t kind = bytes.below(4);
    if (kind == 0 && meshes.size() < kMostMeshes) addMesh(pipeline, bytes, choices, cloth, meshes);
    if (kind > 1 || meshes.empty()) return;
    const std::size_t at = bytes.below(std::uint32_t(meshes.size()));
    if (kind == 1 && bytes.below(2))
    {
        pipeline.remove(meshes[at].m_id);
        meshes.erase(meshes.begin() + std::ptrdiff_t(at));
    }
    else if (kind == 1 && !cloth)
    {
        for (float& coordinate : meshes[at].m_positions)
            coordinate = bytes.number();
        pipeline.moveObstacle(meshes[at].m_id, meshes[at].m_positions.data());
        if (bytes.below(2)) place(pipeline, bytes, meshes[at]);
    }
}

void writeNodes(drape::Pipeline& pipeline, Bytes& bytes, std::vector<Mesh>& cloths)
{
    for (Mesh& cloth : cloths)
    {
        const bool still = bytes.below(3) == 0;
        float* start = pipeline.clothStart(cloth.m_id);
        float* end = pipeline.clothEnd(cloth.m_id);
        for (std::size_t i = 0; i < cloth.m_positions.size(); ++i)
        {
            start[i] = cloth.m_positions[i];
            if (!still) cloth.m_positions[i] = bytes.number();
            end[i] = cloth.m_positions[i];
        }
    }
}

bool isBefore(const drape::Contact& a, const drape::Contact& b)
{
    return std::tie(a.m_featureIndex, a.m_obstacleFeature) < std::tie(b.m_featureIndex, b.m_obstacleFeature);
}

bool areSame(const drape::Contact& a, const drape::Contact& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

// A contact's own numbers, and its place after the one before.
void check(const drape::Contact& contact, const drape::Contact* last)
{
    float square = 0;
    for (int i = 0; i < 3; ++i)
    {
        require(std::isfinite(contact.m_normal[i]) && std::isfinite(contact.m_point[i]));
        square += contact.m_normal[i] * contact.m_normal[i];
    }
    require(std::fabs(square - 1.0f) < 1e-2f);
    require(std::isfinite(contact.m_gap0) && std::isfinite(contact.m_gap1));
    require(contact.m_time >= 0.0f && contact.m_time <= 1.0f);
    require(!last || isBefore(*last, contact));
}

bool addUpToOne(const float* weights, int count)
{
    float sum = 0;
    for (int i = 0; i < count; ++i)
        sum += weights[i];
    return std::fabs(sum - 1.0f) < 1e-4f;
}

// The contacts of a step, those of cloths with themselves last.
std::vector<drape::Contact> checked(const drape::Pipeline& pipeline, const drape::Settings& settings,
                                    const drape::ContactList& contacts)
{
    const drape::ContactList self = pipeline.selfContacts();
    require(contacts.size() + self.size() <= settings.m_contactLimit);
    std::vector<drape::Contact> all;
    for (const drape::Contact& contact : contacts)
    {
        check(contact, all.empty() ? nullptr : &all.back());
        const drape::ContactView view = pipeline.view(contact);
        require(view.m_cloth != drape::kNoMesh && view.m_obstacle != drape::kNoMesh && view.m_thickness > 0.0f);
        require(addUpToOne(view.m_weights, 3));
        all.push_back(contact);
    }
    for (const drape::Contact& contact : self)
    {
        check(contact, all.empty() ? nullptr : &all.back());
        const drape::SelfContactView view = pipeline.viewSelf(contact);
        const int first = view.m_kind == DRAPE_SELF_EDGE_EDGE ? 2 : 1;
        require(view.m_cloth != drape::kNoMesh && view.m_thickness > 0.0f);
        require(addUpToOne(view.m_weights, first) && addUpToOne(view.m_weights + first, 4 - first));
        all.push_back(contact);
    }
    return all;
}

Choices choicesFrom(Bytes& bytes)
{
    Choices choices;
    drape::Settings& settings = choices.m_settings;
    settings.m_backend = drape::Backend::Host;
    settings.m_mode = drape::ContactMode(bytes.below(3));
    settings.m_activation = float(bytes.below(17)) / 4.0f;
    if (bytes.below(8) == 0) settings.m_candidateLimit = bytes.byte();
    if (bytes.below(8) == 0) settings.m_contactLimit = bytes.byte();
    const std::uint8_t kinds = bytes.last();
    choices.m_badIndices = kinds & 1;
    choices.m_self = kinds & 2;
    return choices;
}

void namePairs(drape::Pipeline& pipeline, Bytes& bytes, const std::vector<Mesh>& cloths,
               const std::vector<Mesh>& obstacles)
{
    for (const Mesh& cloth : cloths)
    {
        for (const Mesh& obstacle : obstacles)
        {
            // A thickness is a length above zero; what is too thin for the adapter is not for the core.
            const float thickness = bytes.length();
            if (thickness > 0.0f) pipeline.addPair(cloth.m_id, obstacle.m_id, thickness);
        }
        if (cloth.m_self && bytes.below(4) != 0) pipeline.addSelf(cloth.m_id);
    }
}

using Steps = std::vector<std::vector<drape::Contact>>;

// Runs the steps that the bytes tell; returns the contacts of each.
Steps run(Bytes bytes, const Choices& choices)
{
    drape::Error error;
    const std::unique_ptr<drape::Pipeline> pipeline = drape::Pipeline::create(choices.m_settings, error);
    require(pipeline != nullptr);
    Steps steps;
    std::vector<Mesh> cloths, obstacles;
    for (int step = 0; step < 6 && (step == 0 || bytes.left()); ++step)
    {
        change(*pipeline, bytes, choices, cloths, true);
        change(*pipeline, bytes, choices, obstacles, false);
        writeNodes(*pipeline, bytes, cloths);
        namePairs(*pipeline, bytes, cloths, obstacles);
        pipeline->submit();
        const drape::ContactList contacts = pipeline->finish();
        steps.push_back(checked(*pipeline, choices.m_settings, contacts));
    }
    return steps;
}

void requireSame(const Steps& a, const Steps& b)
{
    require(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        require(std::equal(a[i].begin(), a[i].end(), b[i].begin(), b[i].end(), areSame));
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Bytes bytes(data, size);
    Choices choices = choicesFrom(bytes);
    const drape::Settings unlimited;
    if (choices.m_settings.m_candidateLimit != unlimited.m_candidateLimit)
    {
        // Another mode has more or fewer candidates, so a limit leaves out other cloths.
        run(bytes, choices);
        choices.m_settings.m_candidateLimit = unlimited.m_candidateLimit;
    }
    const Steps steps = run(bytes, choices);
    if (choices.m_settings.m_mode == drape::ContactMode::Automatic)
    {
        Choices other = choices;
        other.m_settings.m_mode = drape::ContactMode::Continuous;
        requireSame(steps, run(bytes, other));
    }
    return 0;
}
