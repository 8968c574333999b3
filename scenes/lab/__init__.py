"""The lab: small scenes, each of which shows and measures one subject of the physics."""
