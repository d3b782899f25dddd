"""USD: stages with the physics schema (UsdPhysics), over the library `usd-core`; read and written."""
