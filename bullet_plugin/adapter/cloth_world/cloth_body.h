// Makes Bullet's soft body of a cloth's description.
#pragma once

#include <memory>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "drape/cloth_records.h"

namespace drape
{
class SelfCollision;

// A cloth of a world. Views of its nodes may keep the body when the world has let it go.
struct WorldCloth
{
    std::shared_ptr<btSoftBody> m_body;
    std::vector<btScalar> m_masses;  // kg per node, pinned ones included
};

// Throws InvalidInput if a number is out of its range, an array is missing or an index is out of range.
void requireCloth(const ClothDescription& cloth);

// Makes the body at its start, in no world. Adds it to `selfCollision` if it collides with itself. The description has
// been checked.
WorldCloth makeCloth(const ClothDescription& cloth, btSoftBodyWorldInfo& info, SelfCollision& selfCollision);
}  // namespace drape
