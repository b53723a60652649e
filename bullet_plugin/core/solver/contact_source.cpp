#include "contact_source.h"

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

// Returns the gap of the contact's point of the cloth. placeOf: position of a node.
template <class PlaceOf>
float gapAt(const SolverContact& contact, const PlaceOf& placeOf)
{
    Vec3 at = vec3(0, 0, 0);
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        at = vec3AddScaled(at, placeOf(std::size_t(contact.m_nodes[k])), contact.m_weights[k]);
    return vec3Dot(contact.m_normal, vec3Sub(at, contact.m_point)) - contact.m_thickness;
}

// Sets both gaps along the contact's normal. A feature that slid around an edge of the obstacle began behind its
// contact's plane without having been inside the obstacle. Only the depth at the path's end is known then.
void setGaps(const SolverNodes& nodes, float hardness, SolverContact& contact)
{
    contact.m_endGap = gapAt(contact, [&](std::size_t node) { return nodes.end(node); });
    contact.m_startGap =
        gapAt(contact, [&](std::size_t node) { return contact.m_carry.start(node, nodes.start(node)); });
    if (contact.m_startGap < -contact.m_thickness && contact.m_startGap < contact.m_endGap)
        contact.m_startGap = contact.m_endGap;
    contact.m_targetGap = targetGap(contact.m_startGap, hardness, contact.m_thickness);
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
    const float normal[3] = {own.m_normal.x, own.m_normal.y, own.m_normal.z};
    const float point[3] = {own.m_point.x, own.m_point.y, own.m_point.z};
    std::copy(normal, normal + 3, contact.m_normal);
    std::copy(point, point + 3, contact.m_point);
    m_own.push_back(own);
    return contact;
}

SolverContact ContactSource::resolve(const SolverNodes& nodes, float friction, float hardness,
                                     const Contact& found) const
{
    if (found.m_kind == kOwnKind) return m_own[found.m_obstacleFeature];
    const ContactView view = m_pipeline->view(found);
    SolverContact contact;
    for (int k = 0; k < 3; ++k)
    {
        contact.m_nodes[k] = view.m_nodes[k];
        contact.m_weights[k] = view.m_nodes[k] >= 0 ? view.m_weights[k] : 0.0f;
    }
    contact.m_normal = vec3Of(view.m_normal);
    contact.m_point = vec3Of(view.m_point);
    contact.m_thickness = view.m_thickness;
    contact.m_time = view.m_time;
    const ObstacleSurface& surface = m_surfaces.at(view.m_obstacle);
    const auto starts = m_carriedStarts.find(view.m_cloth);
    contact.m_carry = {surface.m_moves ? surface.m_map : nullptr,
                       starts == m_carriedStarts.end() ? nullptr : starts->second};
    contact.m_friction = friction * surface.m_friction;
    setGaps(nodes, hardness, contact);
    return contact;
}

bool ContactSource::planeAt(const Contact& contact, const float nodes[][3], ContactPlane& plane)
{
    return contact.m_kind == DRAPE_FACE_VERTEX && !(contact.m_time < 1) && drape::planeAt(contact, nodes, plane);
}
}  // namespace drape
