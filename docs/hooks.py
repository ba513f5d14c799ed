"""What mkdocs calls while it builds the site: pages that are written then, links, contents."""

from __future__ import annotations

import pages
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from pages import sources


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Gives the contents."""
    config.nav = pages.navigation()
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Adds the generated pages."""
    for path, markdown in pages.pages().items():
        files.append(File.generated(config, path, content=markdown))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Leads links between files of the repository to their pages."""
    del config, files
    return sources.linked(page.file.src_uri, markdown)
