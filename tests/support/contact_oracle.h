// Finds the contacts that a step at rest must report, by brute force in double precision over all features.
//
// The conditions are those of kernels/lib/narrow_phase/feature_contact.h: within reach and locally closest. Only pairs
// that satisfy them strictly, by the margins below, are required. At a seam between two features rounding decides which
// of them reports, and both answers are correct. Own code; see oracle.h. Lengths in metres. O(features²) with a box
// test first.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/support/oracle.h"
#include "tests/support/side.h"

namespace drape::test
{
// A required pair is nearer than reach × (1 - this): twelve roundings of a distance are 7e-7 of it.
constexpr double kReachMargin = 1e-5;
// A required pair's closest points keep this weight from a feature's border. Rounding moves them by about 1e-6 of an
// edge, or that over the sine of the angle between two edges, which is kept above kSineMargin.
constexpr double kWeightMargin = 1e-3;
constexpr double kSineMargin = 0.02;
// A required pair's features are farther apart than this part of the pair's extent. The direction between closer
// features is noise (DRAPE_SEAM).
constexpr double kTouchMargin = 2e-5;

struct RequiredContact
{
    std::uint32_t m_kind, m_clothFeature, m_obstacleFeature;
    double m_distance;
    double m_extent;   // largest coordinate of the pair in a frame at the obstacle's feature
    Vector3 m_normal;  // unit, from the obstacle to the cloth
};

// Returns the contacts of cloth.m_end against obstacle.m_start in canonical order. The cloth must not have passed
// anything.
std::vector<RequiredContact> requiredContacts(const Side& cloth, const Side& obstacle, double reach);

// Returns the offset from the obstacle's feature to the cloth's between their closest points, the cloth at its end.
Vector3 contactOffset(const Contact& contact, const Side& cloth, const Side& obstacle);
// Returns the true distance of the features that a contact names, the cloth at its end.
double contactDistance(const Contact& contact, const Side& cloth, const Side& obstacle);
// Returns the largest coordinate of the features that a contact names, relative to one of the obstacle's vertices.
double contactExtent(const Contact& contact, const Side& cloth, const Side& obstacle);

// Returns true if the contact is the required one: kind and features.
bool sameFeatures(const RequiredContact& required, const Contact& contact);
}  // namespace drape::test
