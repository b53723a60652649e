// Words of this folder's texts for as many pairs of features as a vector has lanes; see one.h.
#define Real Lanes
#define Truth LaneMask
#define RealVec3 LanesVec3
#define RealCone LanesCone
#define RealTriangle LanesTriangle
#define RealArea LanesArea
#define RealBounds LanesBounds
#define RealNear LanesNear
#define RealNodeFace LanesNodeFace
#define RealMovingFace LanesMovingFace
#define RealNearest LanesNearest
#define RealEdges LanesTwoEdges
#define RealEdgePair LanesEdgePair

#define splat(a) lanesSplat(a)
#define zeroVec3() vec3(splat(0.0f), splat(0.0f), splat(0.0f))
#define isNot(truth) lanesNot(truth)
#define choose(truth, yes, no) lanesSelect(truth, yes, no)
#define chooseVec3(truth, yes, no) lanesSelectVec3(truth, yes, no)
#define anyOf(truth) 1
#define isRare(truth) 0
