// Contacts of a step with what they did, and pairs that a step could not keep apart: for games that react to contacts,
// for tests and for drawing.
//
// Plugin::recordContacts() or a listener switches the records on; without them nothing is computed or kept. Results of
// steps do not change. While records are on, the host solves cloth (Settings::m_solverPlace), and brings kept bodies
// to the host, because a device does not report impulses. Metres, seconds and newton seconds, world frame. C++11.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

class btCollisionObject;
class btCollisionShape;
class btSoftBody;
class btSoftBodySolver;

namespace drape
{
// A feature of a mesh. For an obstacle, AtNode means a vertex.
enum class ContactFeature : std::uint8_t
{
    AtNode,  // one node or vertex
    AtEdge,  // two of them
    AtFace   // three of them
};

// A point of a node, an edge or a face of a soft body.
struct ClothPoint
{
    const btSoftBody* m_body;  // null where there is no second soft body
    ContactFeature m_feature;  // the feature on which the point is
    int m_nodes[3];            // indices in m_body->m_nodes; -1 if unused
    float m_weights[3];        // weights of these nodes, with the sum 1; a face's are barycentric
};

// A contact of a soft body with an obstacle, with another soft body or with itself. Pointers are valid until the
// objects are removed; do not keep them over a step.
struct StepContact
{
    ClothPoint m_cloth;                 // the point of the soft body
    ClothPoint m_other;                 // the point of the other soft body, or of the same one; else unused
    const btCollisionObject* m_object;  // the obstacle, or the other soft body
    const btCollisionShape* m_shape;    // the obstacle's shape: of a compound the child; null for a soft body
    // The mesh's part of the obstacle's triangle, as Bullet names it to a btTriangleCallback; -1 for convex shapes and
    // soft bodies.
    int m_part;
    int m_triangle;  // the triangle in that part, for a vertex or an edge one that has it; else like m_part
    ContactFeature m_objectFeature;  // the feature of that triangle, or of m_other
    // True for a contact of a node that Bullet's own algorithm found, beside cloth whose links Drape solves. It has no
    // triangle and no shape.
    bool m_isBullets;
    float m_point[3];       // m, on the obstacle or on the other feature
    float m_normal[3];      // unit vector from there to the side from which the cloth came
    float m_thickness;      // m, the distance at which the two rest
    float m_gap;            // m, distance along the normal where the step ended, thickness subtracted
    float m_predictedGap;   // m, the same at the end of the path that the step began with
    float m_timeOfImpact;   // share of the step in [0, 1); 1 where the path meets nothing
    float m_impulse[3];     // N s, given to m_cloth in the step, friction included; the other side got the opposite
    float m_normalImpulse;  // N s, the part along the normal; positive values push the two apart
};

// The contacts of an internal step of one world.
struct StepContacts
{
    const btSoftBodySolver* m_solver;            // the world's SoftBodySolver
    double m_timeStep;                           // s
    const std::vector<StepContact>& m_contacts;  // valid during the call
};

// Receives the contacts of each internal step, also if there are none.
using ContactListener = std::function<void(const StepContacts&)>;

// Tells why a pair of triangles or features may intersect.
enum class PairFlag : std::uint8_t
{
    StartsIntersecting,  // the two intersect where the step began (kStepStartsIntersecting, kStepClothsMeet)
    Touches,             // features of cloth that were too near to be told apart where the step began
    Forced               // features of cloth that pinned nodes bring together
};

// Two features that the last step did not keep apart. Pointers are valid until the objects are removed; do not keep
// them over a step.
struct FlaggedPair
{
    PairFlag m_flag;                    // the reason
    const btSoftBody* m_body;           // the cloth
    int m_nodes[3];                     // its feature: indices in m_body->m_nodes; -1 if unused
    const btSoftBody* m_otherBody;      // the other cloth, or the same one; null for an obstacle
    int m_otherNodes[3];                // its feature; -1 if unused
    const btCollisionObject* m_object;  // the obstacle, or m_otherBody
    const btCollisionShape* m_shape;    // the obstacle's shape; null for cloth
    int m_part;                         // the part of the obstacle's triangle, see StepContact
    int m_triangle;                     // the obstacle's triangle, see StepContact
    float m_corners[3][3];              // m, the obstacle's triangle where the step began; 0 for cloth
};
}  // namespace drape
