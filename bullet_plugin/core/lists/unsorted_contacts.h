// A step's unsorted contacts on a device: narrow phases list them, and ordering sorts them (ContactSink in
// kernels/lib/step_data/step_views.h).
//
// The numbers of contacts of the cloth features, and their sums, are zero between steps. Few features on a GPU have
// sums, with which every work-item of the ordering computes positions by itself.
#pragma once

#include "bullet_plugin/core/device/buffer.h"
#include "kernels/shared/contact.h"
#include "kernels/shared/feature_sums.h"

namespace drape
{
class UnsortedContacts
{
public:
    // Makes room for the numbers of that many cloth features, and zeroes them.
    void resizeFeatures(Device& device, std::size_t features)
    {
        // Rows of numbers are summed whole.
        const std::size_t rows = (features + DRAPE_SUMMED - 1) / DRAPE_SUMMED * DRAPE_SUMMED;
        m_features = features;
        m_sums = device.isGpu() && few() ? rows : 0;
        const std::size_t numbers = rows + (m_sums > 0 ? DRAPE_FEATURE_SUMS : 0);
        m_featureCounts.reserve(device, numbers);
        m_featureCounts.fill(device, 0, numbers);
        reservePlaces(device);
    }
    // Contents are lost when it grows.
    void reserve(Device& device, std::size_t count)
    {
        m_contacts.reserve(device, count);
        reservePlaces(device);
    }
    // Releases the contacts' memory; reserve it again before use.
    void release()
    {
        m_contacts.release();
        m_ranks.release();
    }

    std::size_t capacity() const { return m_contacts.capacity(); }
    std::size_t features() const { return m_features; }
    // Returns whether sums over all numbers stay small (kernels/lib/ordering/feature_sums.h).
    bool few() const { return m_features <= DRAPE_MOST_SUMMED; }
    // Returns the position of the sums behind the features' numbers; 0 if there are none.
    cl_uint sums() const { return cl_uint(m_sums); }

    Buffer<Contact> m_contacts{"unsorted contacts"};
    Buffer<cl_uint> m_ranks{"unsorted contacts"};  // only with sums
    Buffer<cl_uint> m_featureCounts{"cloth features"};

private:
    void reservePlaces(Device& device)
    {
        if (m_sums > 0)
            m_ranks.reserve(device, m_contacts.capacity());
        else
            m_ranks.release();
    }

    std::size_t m_features = 0, m_sums = 0;
};
}  // namespace drape
