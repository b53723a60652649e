// Words of this folder's texts for one pair of features: a work-item of a GPU, and C++. lanes.h has the same words for
// as many pairs as a CPU's vector has lanes.
//
// The texts compile once for each width, so neither they nor this file have include guards. They include nothing
// themselves. Their functions are overloads, and their types differ in name. A block of includes stands in the
// namespace, begins with one.h or lanes.h and ends with end.h.
#define Real float
#define Truth int
#define RealVec3 Vec3
#define RealCone NormalCone
#define RealTriangle FeatureTriangle
#define RealArea FaceArea
#define RealBounds PairBounds
#define RealNear NearContact
#define RealNodeFace NodeFace
#define RealMovingFace MovingFace
#define RealNearest NearestOfFace
#define RealEdges TwoEdges
#define RealEdgePair EdgePair

// Makes a number or a truth of one that is equal for all pairs.
#define splat(a) (a)
#define zeroVec3() vec3(splat(0.0f), splat(0.0f), splat(0.0f))
#define isNot(truth) (!(truth))
// Chooses numbers or vectors for each pair. Only the chosen one is computed where there is one pair.
#define choose(truth, yes, no) ((truth) ? (yes) : (no))
#define chooseVec3(truth, yes, no) ((truth) ? (yes) : (no))
// Returns whether work that only these pairs need must be done. Lanes do it for all.
#define anyOf(truth) (truth)
// Returns whether these rare pairs need other work. Lanes leave such pairs to the text for one pair.
#define isRare(truth) (truth)
