#include "contact_source.h"

#include <algorithm>

#include "bullet_plugin/core/lists/contact_view.h"

namespace drape
{
namespace
{
// Kind of the contacts that addOwn() makes, whose obstacle feature is their index; no kind of the pipeline's.
constexpr std::uint32_t kOwnKind = 0xffffffffu;

Vec3 vec3Of(const float v[3])
{
    return vec3(v[0], v[1], v[2]);
}

// Sets both gaps along the contact's normal.
void setGaps(const SolverNodes& nodes, const ContactSettings& settings, SolverContact& contact)
{
    const FeatureNodes feature = featureNodes(nodes, contact.m_nodes, contact.m_carry);
    contact.m_gaps = contactGaps(&feature, &contact.m_plane, &settings);
}
}  // namespace

const float* ContactSource::mapOf(MeshId obstacle) const
{
    const ObstacleSurface& surface = m_surfaces.at(obstacle);
    return surface.m_moves ? surface.m_map : nullptr;
}

Contact ContactSource::addOwn(const SolverContact& own)
{
    Contact contact = {};
    contact.m_kind = kOwnKind;
    contact.m_obstacleFeature = std::uint32_t(m_own.size());
    contact.m_weights[0] = 1;
    contact.m_time = 1;
    const float normal[3] = {own.m_plane.m_normal.x, own.m_plane.m_normal.y, own.m_plane.m_normal.z};
    const float point[3] = {own.m_plane.m_point.x, own.m_plane.m_point.y, own.m_plane.m_point.z};
    std::copy(normal, normal + 3, contact.m_normal);
    std::copy(point, point + 3, contact.m_point);
    m_own.push_back(own);
    return contact;
}

SolverContact ContactSource::resolve(const SolverNodes& nodes, float friction, float hardness,
                                     const Contact& found) const
{
    if (found.m_kind == kOwnKind) return m_own[found.m_obstacleFeature];
    const ContactView view = viewContact(*m_scene, *m_pairs, found);
    SolverContact contact;
    for (int k = 0; k < 3; ++k)
    {
        contact.m_nodes[k] = view.m_nodes[k];
        contact.m_plane.m_weights[k] = view.m_nodes[k] >= 0 ? view.m_weights[k] : 0.0f;
    }
    contact.m_plane.m_normal = vec3Of(view.m_normal);
    contact.m_plane.m_point = vec3Of(view.m_point);
    contact.m_thickness = view.m_thickness;
    contact.m_time = view.m_time;
    const ObstacleSurface& surface = m_surfaces.at(view.m_obstacle);
    const auto starts = m_carriedStarts.find(view.m_cloth);
    contact.m_carry = {surface.m_moves ? surface.m_map : nullptr,
                       starts == m_carriedStarts.end() ? nullptr : starts->second};
    contact.m_friction = friction * surface.m_friction;
    setGaps(nodes, {contact.m_thickness, contact.m_friction, hardness, 0}, contact);
    return contact;
}
}  // namespace drape
