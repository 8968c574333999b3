"""Tests of the physics package through its public interface."""
