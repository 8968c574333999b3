"""The lab: one small scene per idea of the physics."""
