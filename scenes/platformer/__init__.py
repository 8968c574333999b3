"""The platformer: one level in three acts, with a hero, enemies, crates, platforms and bombs."""
