// Writing contacts into a soft body as the constraints that Bullet's own solver handles.
//
// Input: a body between predictMotion and solveConstraints, and its contacts. Output: nodes against faces as
// btSoftBody::RContact; obstacle vertices against cloth faces and edges against edges as btSoftBody::SContact against a
// massless proxy node. Contacts that are not violated at the predicted end are not given to Bullet, which would stop or
// even attract the cloth; the closing pass watches them. Left to it are also faces and edges whose nodes' own contacts
// free them already, because Bullet's SContact, once it acts, pulls as well as it pushes; and features with a pinned
// node or with nodes of unequal mass, which SContact would move alike. Cost: linear in the contacts; Bullet's arrays
// are reserved first.
#pragma once

#include <vector>

#include "bullet_plugin/adapter/step_contact.h"

namespace drape
{
class ContactWriter
{
public:
    // Appends to the body's m_rcontacts and m_scontacts. The proxy nodes stay valid until the next reset().
    void write(btSoftBody& body, const std::vector<StepContact>& contacts);
    // Takes the SContacts back, which point to proxy nodes, from the end of the body's array. Call after Bullet has
    // solved.
    static void removeSoftContacts(btSoftBody& body, int sizeBefore);
    void reset(int proxyCapacity);

private:
    void land(const btSoftBody& body, const std::vector<StepContact>& contacts);
    bool stillViolated(const StepContact& contact) const;
    void appendSoft(btSoftBody& body, const StepContact& contact);

    std::vector<btVector3> m_landed;  // where the nodes' own contacts bring them; set for the nodes of contacts only
    btAlignedObjectArray<btSoftBody::Node> m_proxies;  // reserved by reset(): addresses are stable within a step
};

// Share of the normal approach that each of Bullet's iterations must take away so that, after all of them, the node has
// come exactly startGap closer: (1 - s)^iterations = startGap / approach. 1 when there was no gap to use up.
btScalar approachShare(btScalar startGap, btScalar approach, int iterations);
}  // namespace drape
