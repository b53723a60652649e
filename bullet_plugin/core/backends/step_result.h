// The result of a step on a back end: its contacts and counts, or the limit that it exceeded.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "bullet_plugin/core/ordering/contact_list.h"

namespace drape
{
struct StepResult
{
    std::vector<Contact> m_contacts;  // the host's contacts
    ContactList m_deviceContacts;     // the device back end's memory, until its next step
    bool m_isOnDevice = false;        // the contacts stayed on the device; the lists are empty
    std::size_t m_countOnDevice = 0;  // their number
    bool m_isRepeated = false;        // the step ran more than once
    // More candidates or contacts than the limits allow; only m_contactDemand of the result is valid then.
    bool m_overLimit = false;
    bool m_overTests = false;           // these are the limits of StepPairs
    std::uint64_t m_contactDemand = 0;  // number of contacts if they exceeded the limit; 0 if candidates did

    // Resets the result; the memory of the host's contacts is kept.
    void clear()
    {
        std::vector<Contact> contacts = std::move(m_contacts);
        contacts.clear();
        *this = StepResult();
        m_contacts = std::move(contacts);
    }

    // Returns contacts with obstacles, then those of cloths with themselves.
    ContactList allContacts() const
    {
        return m_contacts.empty() ? m_deviceContacts : ContactList{m_contacts.data(), m_contacts.size()};
    }
    ContactList contacts() const
    {
        const ContactList all = allContacts();
        return {all.m_first, std::size_t(firstSelf(all) - all.begin())};
    }
    ContactList selfContacts() const
    {
        const ContactList all = allContacts();
        const Contact* first = firstSelf(all);
        return {first, std::size_t(all.end() - first)};
    }

private:
    static const Contact* firstSelf(ContactList all)
    {
        return std::partition_point(all.begin(), all.end(),
                                    [](const Contact& contact) { return contact.m_kind < DRAPE_SELF_NODE_FACE; });
    }
};
}  // namespace drape
