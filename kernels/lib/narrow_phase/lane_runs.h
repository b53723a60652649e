// Runs feature tests on a CPU, as many of one kind side by side as there are lanes. The including file defines the
// functions that are only declared here, for its own tests. For kernels only.
#ifndef DRAPE_LIB_LANE_RUNS_H
#define DRAPE_LIB_LANE_RUNS_H

#include "../work_items/item_runs.h"
#include "../work_items/simd_group.h"
#include "lane_contacts.h"
#include "list_contacts.h"

// Maximum kinds of tests, and maximum rows of numbers of one test.
#define DRAPE_LANE_KINDS 3
#define DRAPE_LANE_ROWS 37
// Minimum tests of a kind for lanes; fewer run one by one.
#define DRAPE_FEWEST_LANES 3u

// Data for a work-item's tests.
typedef struct LaneWork LaneWork;

// Returns the kind of a test, below DRAPE_LANE_KINDS.
static uint kindOf(const LaneWork* work, const uint item);
// Stores the numbers of a test in its lane.
static void putTest(float* rows, const uint lane, LaneWork* work, const uint item);
// Computes the lanes' contacts of tests of one kind.
static void askLanes(LaneContacts* contacts, const float* rows, const LaneWork* work, const uint kind);
// Stores the contact of a test's features, which are near, unless their neighbours forbid it. rows: of the test's lane.
// Returns DRAPE_NO_CONTACT, ….
static int takeContact(const NearContact* near, const float* rows, const uint lane, const LaneWork* work,
                       const uint item, Contact* contact);
// Does a test by itself.
static void testOne(LaneWork* work, const uint item);

// Tests items[0] … items[count - 1], all of one kind, at most one per lane.
static void testLanes(LaneWork* work, const uint kind, const uint* items, const uint count, const ContactSink* sink)
{
    float rows[DRAPE_LANE_ROWS * DRAPE_LANES];
    LaneContacts contacts;
    Contact listed[DRAPE_LANES];
    uint listedCount = 0;
    for (uint lane = 0; lane < DRAPE_LANES; ++lane)
        putTest(rows, lane, work, items[min(lane, count - 1)]);
    askLanes(&contacts, rows, work, kind);
    const uint used = (1u << count) - 1u, asking = laneBits(contacts.m_near.m_asks);
    for (uint left = laneBits(contacts.m_found) & used; left; left &= left - 1)
    {
        const uint lane = 31 - clz(left & -left);
        const NearContact near = nearOfLane(&contacts.m_near, lane, asking >> lane & 1u);
        listedCount += takeContact(&near, rows, lane, work, items[lane], listed + listedCount) == DRAPE_IS_CONTACT;
    }
    listContacts(sink, listed, listedCount);
    for (uint left = laneBits(contacts.m_open) & used; left; left &= left - 1)
        testOne(work, items[31 - clz(left & -left)]);
}

// Tests a run of items, at most DRAPE_MOST_RUN. A continuous step searches every pair for a meeting: one by one.
static void testRun(LaneWork* work, const uint first, const uint end, const uint mode, const ContactSink* sink)
{
    uint items[DRAPE_LANE_KINDS][DRAPE_MOST_RUN], counts[DRAPE_LANE_KINDS] = {0, 0, 0};
    for (uint item = first; item < end; ++item)
    {
        const uint kind = kindOf(work, item);
        items[kind][counts[kind]++] = item;
    }
    for (uint kind = 0; kind < DRAPE_LANE_KINDS; ++kind)
    {
        for (uint i = 0; i < counts[kind]; i += DRAPE_LANES)
        {
            const uint count = min(counts[kind] - i, (uint)DRAPE_LANES);
            if (count >= DRAPE_FEWEST_LANES && mode != DRAPE_CONTINUOUS)
                testLanes(work, kind, items[kind] + i, count, sink);
            else
                for (uint k = 0; k < count; ++k)
                    testOne(work, items[kind][i + k]);
        }
    }
}

#endif
