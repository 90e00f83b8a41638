"""Shared by all commands: output streams, messages, progress and arguments."""
