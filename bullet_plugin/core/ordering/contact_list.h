// Contacts in memory that a back end owns, on the host or on its device.
#pragma once

#include <cstddef>

#include "kernels/shared/contact.h"

namespace drape
{
template <class T>
class Buffer;

struct ContactList
{
    const Contact* m_first = nullptr;
    std::size_t m_count = 0;

    const Contact* begin() const { return m_first; }
    const Contact* end() const { return m_first + m_count; }
    std::size_t size() const { return m_count; }
    const Contact& operator[](std::size_t i) const { return m_first[i]; }
};

// The place of a step's contacts.
enum class ContactPlace
{
    Host,
    Device  // until they are asked for
};

// A step's list on the device, behind a head of DRAPE_CONTACT_HEAD elements with the step's counters. Commands enqueued
// after the step find it complete.
struct DeviceContacts
{
    Buffer<Contact>* m_list = nullptr;
    std::size_t m_room = 0;      // maximum number of contacts
    std::size_t m_expected = 0;  // expected number; affects speed alone
};
}  // namespace drape
