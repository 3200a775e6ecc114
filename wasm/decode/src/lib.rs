//! Image and model files decoded.
