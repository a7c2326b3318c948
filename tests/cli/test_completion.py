"""`calm completion`: what bash makes of it, and that zsh and fish are given theirs."""

import shutil
import subprocess

import pytest

COMPLETES = """\
source calm.bash
COMP_WORDS=({words}); COMP_CWORD={last}; COMP_LINE='{words}'; COMP_POINT=${{#COMP_LINE}}
$(complete -p calm | sed 's/.*-F \\([^ ]*\\).*/\\1/')
echo "${{COMPREPLY[@]}}"
"""


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash")
@pytest.mark.parametrize(
    ("words", "offered"),
    [("calm ru", "run"), ("calm run --env", "--environment"), ("calm catalog se", "search")],
)
def test_bash_completes_commands_and_options(calm, folder, words, offered):
    (folder / "calm.bash").write_text(calm("completion", "bash").out)
    script = COMPLETES.format(words=words, last=len(words.split()) - 1)
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == [offered]
    assert not done.stderr


@pytest.mark.parametrize(("shell", "head"), [("zsh", "#compdef calm"), ("fish", "# Fish")])
def test_other_shells_have_a_script_of_their_own(calm, shell, head):
    done = calm("completion", shell)
    assert (done.code, done.err) == (0, "")
    assert done.out.startswith(head)
    assert "environment" in done.out


def test_a_shell_that_is_not_known(calm):
    done = calm("completion", "tcsh")
    assert (done.code, done.out) == (2, "")
    assert '"bash", "zsh", "fish"' in done.err
