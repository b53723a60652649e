// Anything as meshes, motions and settings, on the host back end: some steps with meshes that come, go and move.
//
// What must hold: no crash, no undefined behaviour, contacts that are finite, unit, in canonical order and within the
// limits, and those of an automatic step are those of a continuous one. Indices are kept in range, which is the
// caller's duty; everything else is as the bytes say.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <tuple>
#include <vector>

#include "bullet_plugin/core/pipeline.h"

namespace
{
void require(bool good)
{
    if (!good) std::abort();
}

// Values out of the input; zeros when it has ended.
class Bytes
{
public:
    Bytes(const std::uint8_t* data, std::size_t size) : m_data(data), m_size(size) {}
    bool left() const { return m_at < m_size; }
    std::uint8_t byte() { return left() ? m_data[m_at++] : 0; }
    std::uint32_t below(std::uint32_t count) { return byte() % count; }

    // Mostly numbers that meet each other, and any bits at all.
    float number()
    {
        const std::uint8_t kind = byte();
        if (kind < 200) return float(kind % 32) / 16.0f - 1.0f;
        if (kind < 240) return std::ldexp(float(std::int8_t(byte())), int(byte()) - 128);
        std::uint32_t bits = 0;
        for (int i = 0; i < 4; ++i)
            bits = bits << 8 | byte();
        float value;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }

private:
    const std::uint8_t* m_data;
    std::size_t m_size, m_at = 0;
};

struct Mesh
{
    drape::MeshId m_id;
    std::vector<float> m_positions;
};

constexpr std::uint32_t kMostVertices = 24, kMostTriangles = 32;
constexpr std::size_t kMostMeshes = 4;

Mesh addMesh(drape::Pipeline& pipeline, Bytes& bytes, bool cloth)
{
    Mesh mesh;
    const std::uint32_t vertices = bytes.below(kMostVertices), triangles = vertices ? bytes.below(kMostTriangles) : 0;
    for (std::uint32_t i = 0; i < 3 * vertices; ++i)
        mesh.m_positions.push_back(bytes.number());
    std::vector<std::int32_t> indices;
    for (std::uint32_t i = 0; i < 3 * triangles; ++i)
        indices.push_back(std::int32_t(bytes.below(vertices)));
    drape::MeshDescription description;
    description.m_triangles = indices.data();
    description.m_triangleCount = triangles;
    description.m_positions = mesh.m_positions.data();
    description.m_vertexCount = vertices;
    description.m_oneSided = !cloth && bytes.below(4) == 0;
    mesh.m_id = cloth ? pipeline.addCloth(description) : pipeline.addObstacle(description);
    return mesh;
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

void change(drape::Pipeline& pipeline, Bytes& bytes, std::vector<Mesh>& meshes, bool cloth)
{
    const std::uint32_t kind = bytes.below(4);
    if (kind == 0 && meshes.size() < kMostMeshes) meshes.push_back(addMesh(pipeline, bytes, cloth));
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

void check(const drape::Pipeline& pipeline, const drape::Settings& settings, const drape::ContactList& contacts)
{
    require(contacts.size() <= settings.m_contactLimit);
    const drape::Contact* last = nullptr;
    for (const drape::Contact& contact : contacts)
    {
        float square = 0, weights = 0;
        for (int i = 0; i < 3; ++i)
        {
            require(std::isfinite(contact.m_normal[i]) && std::isfinite(contact.m_point[i]));
            square += contact.m_normal[i] * contact.m_normal[i];
            weights += contact.m_weights[i];
        }
        require(std::fabs(square - 1.0f) < 1e-2f && std::fabs(weights - 1.0f) < 1e-4f);
        require(std::isfinite(contact.m_gap0) && std::isfinite(contact.m_gap1));
        require(contact.m_time >= 0.0f && contact.m_time <= 1.0f);
        require(!last ||
                std::tie(last->m_slot, last->m_obstacleFeature) < std::tie(contact.m_slot, contact.m_obstacleFeature));
        last = &contact;
        const drape::ContactView view = pipeline.view(contact);
        require(view.m_cloth != drape::kNoMesh && view.m_obstacle != drape::kNoMesh && view.m_thickness > 0.0f);
    }
}

drape::Settings settingsFrom(Bytes& bytes)
{
    drape::Settings settings;
    settings.m_backend = drape::Backend::Host;
    settings.m_mode = drape::ContactMode(bytes.below(3));
    settings.m_activation = float(bytes.below(17)) / 4.0f;
    settings.m_reportIntersections = bytes.below(2) == 1;
    if (bytes.below(8) == 0) settings.m_candidateLimit = bytes.byte();
    if (bytes.below(8) == 0) settings.m_contactLimit = bytes.byte();
    return settings;
}

// Runs the steps that the bytes tell; returns the contacts of all.
std::vector<drape::Contact> run(Bytes bytes, const drape::Settings& settings)
{
    drape::Error error;
    const std::unique_ptr<drape::Pipeline> pipeline = drape::Pipeline::create(settings, error);
    require(pipeline != nullptr);
    std::vector<drape::Contact> all;
    std::vector<Mesh> cloths, obstacles;
    for (int step = 0; step < 6 && (step == 0 || bytes.left()); ++step)
    {
        change(*pipeline, bytes, cloths, true);
        change(*pipeline, bytes, obstacles, false);
        writeNodes(*pipeline, bytes, cloths);
        for (const Mesh& cloth : cloths)
        {
            for (const Mesh& obstacle : obstacles)
            {
                const float thickness = std::fabs(bytes.number());
                // A thickness is a length above zero; what is too thin for the adapter is not for the core.
                if (thickness > 0.0f && thickness < 1e9f) pipeline->addPair(cloth.m_id, obstacle.m_id, thickness);
            }
        }
        pipeline->submit();
        const drape::ContactList contacts = pipeline->finish();
        check(*pipeline, settings, contacts);
        all.insert(all.end(), contacts.begin(), contacts.end());
    }
    return all;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Bytes bytes(data, size);
    drape::Settings settings = settingsFrom(bytes);
    const std::vector<drape::Contact> contacts = run(bytes, settings);
    if (settings.m_mode != drape::ContactMode::Automatic) return 0;
    settings.m_mode = drape::ContactMode::Continuous;
    const std::vector<drape::Contact> continuous = run(bytes, settings);
    require(contacts.size() == continuous.size());
    require(contacts.empty() ||
            std::memcmp(contacts.data(), continuous.data(), contacts.size() * sizeof(drape::Contact)) == 0);
    return 0;
}
