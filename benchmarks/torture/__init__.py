"""Scenes that should break a program, each with criteria that can fail: python -m benchmarks.torture."""
