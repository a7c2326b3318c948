"""`calm page` on the command line."""


def test_it_says_where_the_page_is_and_how_to_see_it(calm, folder):
    done = calm("page", "-o", "site")
    assert (done.code, done.out) == (0, "")
    assert done.err.startswith("Page written to site (")
    assert "python -m http.server -d site" in done.err
    assert (folder / "site/index.html").is_file()


def test_a_folder_that_is_none_is_refused(calm, folder):
    (folder / "site").write_text("a file")
    done = calm("page", "-o", "site")
    assert done.code == 2
    assert "the output must be a folder" in done.err


def test_a_runtime_that_is_not_there(calm):
    done = calm("page", "-o", "site", "--runtime", "nowhere")
    assert done.code == 2
    assert done.err == "calm: --runtime: there is no folder nowhere\n"
