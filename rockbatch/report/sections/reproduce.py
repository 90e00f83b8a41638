"""Inputs, versions and machine from which the results can be reproduced."""

import shlex

from rockbatch.report.contents import Contents
from rockbatch.report.document import Section
from rockbatch.report.markup import join, tag


def section(contents: Contents) -> Section:
    """Return the study file, and the command, versions and machine of a run."""
    study, finished = contents.study, contents.finished
    text = tag("pre", tag("code", study["text"]))
    if finished is None:
        return Section("The study file", "study", text)
    info = finished.info
    versions = ", ".join(f"{name} {version}" for name, version in info["versions"].items())
    facts = [
        ("Command", tag("code", shlex.join(info["command"]))),
        ("Study", tag("code", study["path"])),
        ("SHA-256", tag("code", study["sha256"])),
        ("Made", info["created"]),
        ("rockbatch", info["rockbatch"]),
        ("With", versions),
        ("Machine", info["machine"]),
    ]
    listed = tag("dl", *(join(tag("dt", name), tag("dd", value)) for name, value in facts))
    return Section("How to reproduce", "reproduce", join(listed, tag("h3", "The study file"), text))
