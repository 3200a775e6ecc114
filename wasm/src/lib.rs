//! The core of fluoropose for a page.
