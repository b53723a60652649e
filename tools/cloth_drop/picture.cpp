#include "tools/cloth_drop/picture.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "scenes/cloth_rope.h"
#include "tools/cloth_drop/picture_label.h"
#include "tools/cloth_drop/smooth_mesh.h"

namespace drape
{
namespace
{
// Size of the only panel, in pixels.
constexpr int kWidth = 1280, kHeight = 960;
constexpr int kSideWidth = 720, kSideHeight = 720;  // size of each panel if there are several
constexpr int kGap = 8;                             // pixels between panels
constexpr int kStrata = 6;                          // samples a pixel and axis; each carries one shadow and one sky ray
constexpr std::size_t kSmoothTriangles =
    100000;                                    // a coarse cloth is drawn with at least so many: none looks like facets
constexpr std::size_t kMeshTriangles = 20000;  // edges of larger cloths would hide the cloth
constexpr double kEdgeWidth = 0.0011;          // half width of an edge in radii of the view
constexpr double kRopeRadius = 0.005;          // radius of a rope in radii of the view
constexpr double kPi = 3.14159265358979323846;
constexpr double kFieldOfView = 30 * kPi / 180;

const Vector3 kClothFront = {0.42, 0.025, 0.04}, kClothBack = {0.62, 0.36, 0.12};
const Vector3 kClothEdge = {0.09, 0.004, 0.008};
const Vector3 kStone = {0.50, 0.50, 0.49}, kFloor = {0.60, 0.61, 0.63};
const Vector3 kSkyLow = {0.62, 0.66, 0.71}, kSkyHigh = {0.78, 0.83, 0.90};
const Vector3 kKeyLight = {3.1, 2.8, 2.4}, kSkyLight = {0.48, 0.54, 0.64};
const Vector3 kTowardsLight = normalized({-0.75, 1.0, -0.1});
constexpr double kLightSpread = 0.12;  // radius of the light's disc seen from unit distance: soft shadows

struct Sample
{
    double u, v;
};

// Hashes pixel and purpose to a point in the unit square (PCG's output function over a mixed counter).
double hashUnit(std::uint32_t seed)
{
    std::uint32_t state = seed * 747796405u + 2891336453u;
    state = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return ((state >> 22) ^ state) * (1.0 / 4294967296.0);
}

// Returns one of strata² cells, jittered and rotated by a pixel's own offset, so that a pixel's samples cover the
// square evenly.
Sample stratum(std::uint32_t pixel, int index, std::uint32_t purpose, int strata)
{
    const int cells = strata * strata;
    const int cell =
        static_cast<int>((static_cast<std::uint32_t>(index) * 7u + purpose * 11u) % static_cast<unsigned>(cells));
    const std::uint32_t seed = pixel * 2654435761u + purpose * 40503u;
    const double jitterU = hashUnit(seed + static_cast<std::uint32_t>(index) * 97u);
    const double jitterV = hashUnit(seed + static_cast<std::uint32_t>(index) * 131u + 17u);
    const double u = (cell % strata + jitterU) / strata + hashUnit(seed ^ 0x68bc21ebu);
    const double v = (cell / strata + jitterV) / strata + hashUnit(seed ^ 0x02e5be93u);
    return {u - std::floor(u), v - std::floor(v)};
}

void basis(const Vector3& axis, Vector3& right, Vector3& up)
{
    right = normalized(cross(std::fabs(axis.y) < 0.9 ? Vector3{0, 1, 0} : Vector3{1, 0, 0}, axis));
    up = cross(axis, right);
}

Vector3 cosineDirection(const Vector3& normal, const Sample& sample)
{
    Vector3 right, up;
    basis(normal, right, up);
    const double radius = std::sqrt(sample.u), angle = 2 * kPi * sample.v;
    return radius * std::cos(angle) * right + radius * std::sin(angle) * up +
           std::sqrt(std::max(0.0, 1 - sample.u)) * normal;
}

Vector3 lightDirection(const Sample& sample)
{
    Vector3 right, up;
    basis(kTowardsLight, right, up);
    const double radius = kLightSpread * std::sqrt(sample.u), angle = 2 * kPi * sample.v;
    return normalized(kTowardsLight + radius * std::cos(angle) * right + radius * std::sin(angle) * up);
}

Vector3 multiply(const Vector3& a, const Vector3& b)
{
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

Vector3 mix(const Vector3& a, const Vector3& b, double share)
{
    return (1 - share) * a + share * b;
}

Vector3 sky(const Vector3& direction)
{
    return mix(kSkyLow, kSkyHigh, std::clamp(2 * direction.y, 0.0, 1.0));
}

Vector3 albedo(const SurfacePoint& hit, const View& view)
{
    if (hit.m_surface == Surface::Floor) return kFloor;
    if (hit.m_surface == Surface::Obstacle) return kStone;
    if (hit.m_edge < kEdgeWidth * view.m_radius) return kClothEdge;
    return hit.m_back ? kClothBack : kClothFront;
}

Vector3 shade(const RayScene& scene, const Vector3& direction, const SurfacePoint& hit, std::uint32_t pixel, int index,
              int strata)
{
    if (hit.m_surface == Surface::None) return sky(direction);
    const Vector3 origin = hit.m_point + (1e-4 * scene.view().m_radius) * hit.m_flat;
    const Vector3 towardsLight = lightDirection(stratum(pixel, index, 1, strata));
    const Vector3 skyRay = cosineDirection(hit.m_normal, stratum(pixel, index, 2, strata));
    const double facing = std::max(0.0, dot(hit.m_normal, towardsLight));
    const bool lit = facing > 0 && !scene.blocked(origin, towardsLight, 1e9);
    const bool open = dot(hit.m_flat, skyRay) > 0 && !scene.blocked(origin, skyRay, 1.5 * scene.view().m_radius);
    Vector3 light = (lit ? facing / kPi : 0.0) * kKeyLight;
    // The sky lights from above, and the floor reflects a little light from below.
    const Vector3 fill = skyRay.y > 0 ? kSkyLight : 0.45 * kSkyLight;
    light += (open ? 1.0 : 0.12) * fill;
    Vector3 colour = multiply(albedo(hit, scene.view()), light);
    if (hit.m_surface == Surface::Cloth)  // sheen of woven fibres at grazing view
    {
        const double grazing = std::pow(1 - std::fabs(dot(hit.m_normal, direction)), 4);
        colour += (open ? 0.12 * grazing : 0.0) * kSkyLight;
    }
    if (hit.m_surface != Surface::Floor) return colour;
    const double away = length(hit.m_point - scene.view().m_centre) / scene.view().m_radius;
    return mix(colour, sky(direction), std::clamp((away - 2.0) / 6.0, 0.0, 1.0));
}

std::uint8_t encode(double linear)
{
    const double mapped = linear / (1 + 0.18 * linear) * 1.08;  // soft shoulder for the highlights
    const double value = mapped <= 0.0031308 ? 12.92 * mapped : 1.055 * std::pow(mapped, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

struct Camera
{
    Vector3 m_eye, m_forward, m_right, m_up;
    int m_width, m_height;  // pixels

    Camera(const View& view, int width, int height) : m_width(width), m_height(height)
    {
        m_forward = normalized({1.0, -0.30, -0.75});
        const double distance = 0.86 * view.m_radius / std::sin(0.5 * kFieldOfView);
        m_eye = view.m_centre - distance * m_forward;
        m_right = normalized(cross(m_forward, {0, 1, 0}));
        m_up = cross(m_right, m_forward);
    }

    Vector3 direction(double x, double y) const
    {
        const double scale = 2 * std::tan(0.5 * kFieldOfView) / m_height;
        return normalized(m_forward + scale * (x - 0.5 * m_width) * m_right + scale * (0.5 * m_height - y) * m_up);
    }
};

// Draws row y of the panel whose first column in the image is `left`, with strata² samples a pixel.
void renderRow(const RayScene& scene, const Camera& camera, int strata, int y, int left, Image& image)
{
    for (int x = 0; x < camera.m_width; ++x)
    {
        const auto pixel = static_cast<std::uint32_t>(y * camera.m_width + x);
        Vector3 sum;
        for (int index = 0; index < strata * strata; ++index)
        {
            const Sample place = {(index % strata + 0.5) / strata, (index / strata + 0.5) / strata};
            const Vector3 direction = camera.direction(x + place.u, y + place.v);
            sum += shade(scene, direction, scene.trace(camera.m_eye, direction), pixel, index, strata);
        }
        const Vector3 mean = (1.0 / (strata * strata)) * sum;
        for (int axis = 0; axis < 3; ++axis)
            image.at(left + x, y)[axis] = encode(mean[axis]);
    }
}

// Draws the rows on all cores. Returns false when the caller gave the picture up.
bool renderPanel(int height, const std::function<void(int)>& renderRowOf, const PictureHooks& hooks, int rowsBefore)
{
    std::atomic<int> nextRow{0}, rowsDone{0};
    std::atomic<bool> givenUp{false};
    const auto takeRow = [&]
    {
        const int row = givenUp ? height : nextRow++;
        if (row >= height) return false;
        renderRowOf(row);
        ++rowsDone;
        return true;
    };
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
        try
        {
            threads.emplace_back(
                [&]
                {
                    while (takeRow())
                    {
                    }
                });
        }
        catch (const std::system_error&)
        {
            break;  // fewer threads draw the same picture
        }
    while (takeRow())
    {
        if (hooks.m_progress) hooks.m_progress(rowsBefore + rowsDone);
        if (hooks.m_goesOn && !hooks.m_goesOn()) givenUp = true;
    }
    for (std::thread& thread : threads)
        thread.join();
    if (hooks.m_progress && !givenUp) hooks.m_progress(rowsBefore + height);
    return !givenUp;
}

// Adds the tubes of ropes, without edges.
void addRopes(const PicturePanel& panel, double radius, ShadedMesh& shaded)
{
    const TriangleMesh tubes = tubesAround(panel.m_cloth.m_positions, panel.m_lines, radius);
    const std::vector<Vector3> normals = vertexNormals(tubes);
    const auto first = std::int32_t(shaded.m_mesh.vertexCount());
    for (const std::int32_t vertex : tubes.m_triangles)
        shaded.m_mesh.m_triangles.push_back(first + vertex);
    std::vector<float>& positions = shaded.m_mesh.m_positions;
    positions.insert(positions.end(), tubes.m_positions.begin(), tubes.m_positions.end());
    shaded.m_normals.insert(shaded.m_normals.end(), normals.begin(), normals.end());
    if (!shaded.m_edges.empty()) shaded.m_edges.resize(shaded.m_mesh.triangleCount());
}

ShadedMesh shadedCloth(const TriangleMesh& cloth)
{
    int levels = 0;
    for (std::size_t count = cloth.triangleCount(); count > 0 && count < kSmoothTriangles; count *= 4)
        ++levels;
    return smoothMesh(cloth, levels, cloth.triangleCount() <= kMeshTriangles);
}

int heightOf(std::size_t panels)
{
    return panels > 1 ? kSideHeight : kHeight;
}
}  // namespace

int pictureRows(std::size_t panels)
{
    return static_cast<int>(panels) * heightOf(panels);
}

PictureSize pictureSize(std::size_t panels)
{
    return {panels > 1 ? kSideWidth : kWidth, heightOf(panels), kStrata};
}

bool drawPicture(const std::vector<PicturePanel>& panels, const TriangleMesh& obstacle, const View& view,
                 const PictureSize& size, const PictureHooks& hooks, Image& image, std::string& error)
{
    const int count = static_cast<int>(panels.size());
    image = Image(count * size.m_width + (count - 1) * kGap, size.m_height);
    for (int i = 0; i < count; ++i)
    {
        const PicturePanel& panel = panels[static_cast<std::size_t>(i)];
        ShadedMesh cloth = shadedCloth(panel.m_cloth);
        addRopes(panel, kRopeRadius * view.m_radius, cloth);
        const RayScene scene(std::move(cloth), {obstacle, vertexNormals(obstacle), {}, true}, view);
        if (!scene.good())
        {
            error = "cannot draw: Embree did not start";
            return false;
        }
        const Camera camera(view, size.m_width, size.m_height);
        const int left = i * (size.m_width + kGap);
        const auto row = [&](int y) { renderRow(scene, camera, size.m_samples, y, left, image); };
        if (!renderPanel(size.m_height, row, hooks, i * size.m_height)) return false;
        if (count > 1) drawLabel(panel.m_title, panel.m_remark, left, size.m_width, image);
    }
    return true;
}

bool writePicture(const std::string& path, const std::vector<PicturePanel>& panels, const TriangleMesh& obstacle,
                  const PictureHooks& hooks, std::string& error)
{
    Image image(0, 0);
    const View view = viewOf(shadedCloth(panels.front().m_cloth).m_mesh, obstacle);
    if (drawPicture(panels, obstacle, view, pictureSize(panels.size()), hooks, image, error))
        return writePng(path, image, error);
    if (!error.empty()) error = path + ": " + error;
    return false;
}
}  // namespace drape
