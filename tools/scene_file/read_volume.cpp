#include <cmath>

#include "scenes/mesh_volume.h"
#include "tools/scene_file/scene_parts.h"

namespace drape
{
namespace
{
constexpr Limits kPressure = {0, 1e6};      // N·m
constexpr Limits kConservation = {0, 1e9};  // Pa/m³
constexpr double kLeastVolume = 1e-6;       // share of the cube of the largest extent

bool isFlat(const TriangleMesh& mesh)
{
    return !(volumeOf(mesh) > kLeastVolume * std::pow(double(boundsOf(mesh).largestExtent()), 3));
}
}  // namespace

void readVolume(const JsonObject& object, SceneCloth& cloth)
{
    object.read("pressure", cloth.m_pressure, kPressure);
    object.read("volume_conservation", cloth.m_volumeConservation, kConservation);
    for (const char* key : {"pressure", "volume_conservation"})
    {
        if (!object.has(key)) continue;
        const JsonValue value = object.at(key);
        TriangleMesh& mesh = cloth.m_rest.m_mesh;
        const std::string open = whyNotClosed(mesh);
        if (!open.empty()) value.fail("only a closed mesh has it: " + open);
        turnOutwards(mesh);
        if (isFlat(mesh)) value.fail("the cloth encloses no volume at rest");
        if (isFlat({cloth.m_positions, mesh.m_triangles}))
            value.fail("the cloth encloses no volume where it starts, or is inside out");
    }
}
}  // namespace drape
