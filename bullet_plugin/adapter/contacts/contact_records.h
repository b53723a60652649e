// The contacts of a step with their impulses, as Plugin::stepContacts() and a listener get them.
//
// Job: collect what the detections and the solver report while a step runs, in records of Bullet's objects, each
// contact once. Every call does nothing while records are off. Records are made where a detection's contacts are valid,
// before the next one. Cost while on: linear in the contacts. Errors: exceptions pass through.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "drape/contacts.h"
#include "kernels/lib/geometry/vec3.h"
#include "kernels/shared/contact.h"

class btSoftBody;

namespace drape
{
class FoundContacts;
class RigidRows;

// A contact's push that may be missing from the last detection's list.
struct ContactPush
{
    std::uint64_t m_key;    // see keyOf()
    StepContact m_contact;  // without its impulse
    Vec3 m_impulse;         // N s
};

class ContactRecords
{
public:
    // Switches records on or off, from the next step on.
    void setOn(bool on) { m_isOn = on; }
    bool isOn() const { return m_isOn; }
    // Begins a step without contacts.
    void begin();
    // Returns the records of the last step that ended.
    const std::vector<StepContact>& list() const { return m_list; }
    // Forgets all records.
    void clear()
    {
        begin();
        m_list.clear();
    }

    // Returns a number that is the same for contacts of the same two features in a step.
    static std::uint64_t keyOf(const Contact& contact)
    {
        return std::uint64_t(contact.m_featureIndex) << 32 | contact.m_obstacleFeature;
    }
    // Returns the contact's push, for add().
    static ContactPush pushOf(const FoundContacts& found, const Contact& contact, Vec3 impulse);
    // Adds all contacts of the current detection.
    void addDetected(const FoundContacts& found);
    // Adds an impulse to a contact, which is added if it is new.
    void add(const ContactPush& push);
    // Adds a contact that no detection with obstacles reports.
    void add(const StepContact& contact, Vec3 impulse);
    // Adds the contacts of a body that Bullet's algorithms found. rows: those of the body's solver.
    void addBullets(const btSoftBody& body, const RigidRows& rows);
    // Ends the step: the gaps are those between where the bodies' nodes are now, and contacts.
    void end();

private:
    bool m_isOn = false;
    std::vector<StepContact> m_running, m_list;
    std::unordered_map<std::uint64_t, std::size_t> m_index;  // in m_running, by key
};
}  // namespace drape
