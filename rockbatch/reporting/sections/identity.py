"""What identifies the results: digests of the study, the records, the results and the program."""

from rockbatch.quantities.rows import PEAKS
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.reporting.table import Head, table

OF_RECORDS = (
    "The digest of a record is that of its time step and accelerations [m/s²] as they were run, before the study's scale, in 64 "
    "bits: any change of a sample or factor changes it."
)


def section(finished: Finished) -> Markup:
    """Return the SHA-256 digests of study, results, program and records, with the versions of the packages used."""
    info = finished.info
    packages = ", ".join(f"{name} {version}" for name, version in info["versions"].items())
    commit = info["versions"].get("commit")
    rows = [
        ["study file", info["study"]["path"], info["study"]["sha256"]],
        ["results", PEAKS, (info.get("peaks") or {}).get("sha256", "not noted")],
        ["program", f"rockbatch {info['rockbatch']}" + (f", commit {commit}" if commit else ""), _program(finished)],
    ]
    records = [["record", record["record"], record.get("digest", "not noted")] for record in info["records"]]
    heads = [
        Head("what"),
        Head("name"),
        Head("SHA-256", value="sha256", note="of a record: of its samples as it is run"),
    ]
    return join(
        table(heads, rows + records, name="Digests", prose=True, open_=True),
        tag("p", OF_RECORDS, class_="legend") if records else "",
        tag("p", f"Computed with {packages} on {info['machine']}, {info['created']}.", class_="legend"),
    )


def _program(finished: Finished) -> str:
    """Return the beginning of the digest of all modules that can influence a result, "1f2e3d…"; "not noted" if it is unknown."""
    digest = finished.info.get("digest")
    program = digest.get("program") if isinstance(digest, dict) else None
    return f"{program}…" if isinstance(program, str) else "not noted"
