"""The results of a check: :class:`Finding` and :class:`Report`."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Finding:
    """The result of one rule.

    Attributes:
        rule: The rule in a few words.
        outcome: ``"passed"``, ``"failed"`` or ``"skipped"``.
        detail: What was found if it failed, or why it was skipped; empty if it passed.
        advice: What to do about a failure; empty otherwise.
    """

    rule: str
    outcome: str
    detail: str = ""
    advice: str = ""


@dataclass(frozen=True)
class Report:
    """The results of all rules for one task.

    Attributes:
        task: The task that was checked.
        findings: One for each rule, in the order in which they were checked.
        versions: Of Python, Driftworld, Gymnasium and numpy.
    """

    task: str
    findings: tuple[Finding, ...]
    versions: dict[str, str] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """Whether nothing failed."""
        return all(finding.outcome != "failed" for finding in self.findings)

    def to_dict(self) -> dict[str, Any]:
        """The report as plain values, as ``--json`` prints it."""
        findings = [vars(finding) for finding in self.findings]
        return {"task": self.task, "ok": self.ok, "versions": self.versions, "findings": findings}

    def __str__(self) -> str:
        width = max(len(finding.rule) for finding in self.findings)
        lines = [self.task]
        for finding in self.findings:
            lines.append(f"  {finding.outcome:<7}  {finding.rule:<{width}}  {finding.detail}".rstrip())
            if finding.advice:
                lines.append(f"           → {finding.advice}")
        count = sum(finding.outcome == "failed" for finding in self.findings)
        lines.append(f"  {'all rules passed' if count == 0 else f'{count} of {len(self.findings)} rules failed'}")
        return "\n".join(lines)
