"""The version of the program; part of every generated file and every result."""

VERSION = "0.1.0"
