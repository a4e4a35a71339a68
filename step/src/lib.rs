//! STEP files in and out of perpend's models.

mod face;
mod source;
