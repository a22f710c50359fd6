"""Studies on Dask's workers."""

import pytest
from conftest import SCENARIOS

import emscape as em

distributed = pytest.importorskip("distributed")


def test_workers_compute_what_one_process_does(tmp_path):
    from emscape import distributed as studies

    file = SCENARIOS / "study" / "jammer_power.yaml"
    em.study(file, tmp_path / "processes", jobs=2)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            result = studies.study(file, tmp_path / "dask", client, parts=3)
            assert result["parts"] == 3 and result["missing_parts"] == []
            with pytest.raises(em.InputError, match="parts"):
                studies.study(file, tmp_path / "dask", client, parts=2)
    for name in ("results.csv",):
        assert (tmp_path / "dask" / name).read_bytes() == (tmp_path / "processes" / name).read_bytes()


@pytest.mark.parametrize("parts", [0, -1])
def test_the_number_of_parts_has_a_range(parts, tmp_path):
    from emscape import distributed as studies

    with pytest.raises(em.UsageError, match=f"parts is {parts}, outside the allowed range 1 to the number of variants"):
        studies.study(SCENARIOS / "study" / "jammer_power.yaml", tmp_path / "study", None, parts=parts)


def test_the_error_of_a_worker_has_its_place_without_warnings():
    from emscape.distributed import _error_of

    warnings = "emscape: warning: a.yaml:38:45: the gain of 33.00 dBi is above\n"
    error = _error_of(f"3 {warnings}emscape: error: /data/a.yaml:12:5: unknown key 'power_kw'\n")
    assert isinstance(error, em.InputError)
    assert (error.file, error.line, error.column, error.message) == ("/data/a.yaml", 12, 5, "unknown key 'power_kw'")
    error = _error_of(f"1 {warnings}emscape: error: the disk is full")
    assert (type(error), error.file, error.message) == (em.OtherError, "", "the disk is full")
