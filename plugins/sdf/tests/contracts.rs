//! What the collider promises.

use toile_sdf::SdfCollider;

toile_core::contracts!(SdfCollider);
