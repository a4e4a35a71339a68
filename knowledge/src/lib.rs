//! What is known of an entity.
