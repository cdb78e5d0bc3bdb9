//! Folders of runs: taken, cleared and continued.

use super::*;

fn write(path: PathBuf) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, "x").unwrap();
}

#[test]
fn a_used_folder_is_refused_and_force_clears_only_a_run() {
    let comm = Comm::solo();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deep/run");
    let mut run = RunFolder::at(&path);
    run.take_new(&comm, false, false).unwrap();
    run.create(&comm, "title = 1", false).unwrap();
    assert_eq!(run.status().unwrap().state, Phase::Running);
    let refused = run.create(&comm, "", false).unwrap_err();
    let in_use = matches!(refused, OutputError::FolderInUse { .. });
    assert!(in_use && refused.to_string().contains("--force"));

    write(run.snapshot(3));
    write(run.series());
    write(run.checkpoints().join("step-00000003/manifest.json"));
    write(run.checkpoints().join("step-00000004.partial/state.h5"));
    write(run.snapshots().join("my picture.png"));
    write(run.snapshot_of(Some("close"), 3));
    write(run.series_of(Some("close")));
    write(run.snapshot_of(Some("far"), 3));
    write(run.snapshots_of(Some("far")).join("my picture.png"));
    write(path.join("notes.txt"));
    run.create(&comm, "title = 2", true).unwrap();
    let mut left = names_in(&run.snapshots()).unwrap();
    left.sort();
    let far = run.snapshots_of(Some("far"));
    assert_eq!(left, [far.clone(), run.snapshots().join("my picture.png")]);
    assert_eq!(names_in(&far).unwrap(), [far.join("my picture.png")]);
    assert!(names_in(&run.checkpoints()).unwrap().is_empty());
    assert!(path.join("notes.txt").exists());
    let case = fs::read_to_string(run.case()).unwrap();
    assert_eq!(case, format!("# run {}\ntitle = 2", run.id().unwrap()));
}

#[test]
fn force_leaves_a_folder_alone_that_holds_no_run() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    write(case.clone());
    let refused = RunFolder::at(folder.path())
        .create(&Comm::solo(), "", true)
        .unwrap_err();
    assert!(matches!(refused, OutputError::NotARun { .. }));
    assert_eq!(fs::read_to_string(case).unwrap(), "x");
}

#[test]
fn a_restart_sets_aside_what_came_after_its_checkpoint() {
    let comm = Comm::solo();
    let folder = tempfile::tempdir().unwrap();
    let mut run = RunFolder::at(folder.path());
    run.create(&comm, "", false).unwrap();
    for step in [2, 4, 6] {
        write(run.snapshot(step));
        let time = f64::from(u32::try_from(step).unwrap());
        write(run.snapshot_of(Some("close"), step));
        for series in [run.series(), run.series_of(Some("close"))] {
            series::add(&series, &RunFolder::snapshot_name(step), time).unwrap();
        }
        write(
            run.checkpoints()
                .join(format!("step-{step:08}/manifest.json")),
        );
    }
    write(run.history());
    let names = |run: &RunFolder| {
        let checkpoints = run.checkpoint_folders().unwrap();
        let close = run.snapshot_files_of(Some("close")).unwrap();
        (run.snapshot_files().unwrap(), close, checkpoints)
    };
    let before = names(&run);
    let resume = |run: &mut RunFolder, passed_over: &[PathBuf]| {
        let aside = run.resume(&comm, Some("edited"), 4, 4.0, passed_over);
        aside.unwrap().unwrap()
    };
    // A restart that could not begin leaves the folder as it was.
    let aside = resume(&mut run, &[]);
    fs::remove_file(run.history()).unwrap();
    aside.undo();
    assert_eq!(names(&run), before);
    assert_eq!(series::read(&run.series()).unwrap().len(), 3);
    assert_eq!(run.status().unwrap().step, 0);
    let case = fs::read_to_string(run.case()).unwrap();
    assert!(case.ends_with("\n") && case.lines().count() == 1);
    assert_eq!(fs::read_to_string(run.history()).unwrap(), "x");
    assert_eq!(run.set_aside_folder(), None);

    let damaged = run.checkpoints().join("step-00000006");
    drop(resume(&mut run, std::slice::from_ref(&damaged)));
    let [there] = &checkpoint::list_damaged(&run.checkpoints()).unwrap()[..] else {
        panic!()
    };
    assert!(there.ends_with("step-00000006.damaged") && !damaged.exists());
    let aside = run.set_aside_folder().unwrap().join("1");
    assert!(aside.join("snapshots/step-00000006.vtkhdf").exists());
    assert!(aside.join("history.csv").exists());
    // One more that makes no checkpoint overwrites nothing.
    write(run.snapshot(6));
    drop(resume(&mut run, &[]));
    let again = run.set_aside_folder().unwrap().join("2");
    assert!(aside.exists() && again.join("snapshots/step-00000006.vtkhdf").exists());
    run.forget_set_aside().unwrap();
    assert_eq!(run.set_aside_folder(), None);
    assert_eq!(
        run.snapshot_files().unwrap(),
        [run.snapshot(2), run.snapshot(4)]
    );
    assert_eq!(series::read(&run.series()).unwrap().len(), 2);
    let close = run.snapshot_files_of(Some("close")).unwrap();
    assert_eq!(
        close,
        [2, 4].map(|step| run.snapshot_of(Some("close"), step))
    );
    let close = run.series_of(Some("close"));
    assert!(close.ends_with("snapshots/close/close.vtkhdf.series"));
    assert_eq!(series::read(&close).unwrap().len(), 2);
    assert_eq!(run.schedules().unwrap(), ["close"]);
    let newest = run.checkpoint_folders().unwrap().remove(0);
    assert!(newest.ends_with("step-00000004"));
    assert_eq!(
        RunFolder::of_checkpoint(&newest)
            .unwrap()
            .status()
            .unwrap()
            .step,
        4
    );
}
