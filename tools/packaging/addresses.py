"""Where the project is on the web: the one place that says so, and what the metadata make of it.

Empty as long as the repository has no public address; then the metadata have no `Project-URL`, and no link
leads nowhere.
"""

from __future__ import annotations

# The address of the repository in a browser, without a slash at its end, on a host with GitHub's paths.
REPOSITORY = ""
# That of the documentation's site; if it is empty, the folder `docs` of the repository.
DOCUMENTATION = ""


def project_urls(repository: str = REPOSITORY, documentation: str = DOCUMENTATION) -> dict[str, str]:
    """The `[project.urls]` of the metadata.

    Args:
        repository: The address of the repository; empty if it has none.
        documentation: That of the documentation; empty if it is in the repository.

    Returns:
        Addresses by their labels; none without a repository.

    Raises:
        ValueError: An address does not begin with `https://`, or ends with a slash.
    """
    for address in filter(None, (repository, documentation)):
        if not address.startswith("https://") or address.endswith("/"):
            raise ValueError(
                f"{address!r} in tools/packaging/addresses.py has to begin with https:// and not end with /"
            )
    if not repository:
        return {}
    return {
        "Homepage": documentation or repository,
        "Source": repository,
        "Issues": f"{repository}/issues",
        "Documentation": documentation or f"{repository}/tree/HEAD/docs",
        "Changelog": f"{repository}/blob/HEAD/CHANGELOG.md",
    }
